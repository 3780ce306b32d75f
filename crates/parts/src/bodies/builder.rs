//! A builder that adds a robot's bodies one by one. A bolt consists of a screw and a nut.

use lizard_kinematics::Vector;
use lizard_robot::{Parts, Robot};

use crate::bodies::layout::Layout;
use crate::bodies::names;
use crate::layers::body::{Body, Kind, Mount, Prism};
use crate::layers::shape::Shape;
use crate::layers::stack::{HEAD_PLAY, HEX_HEAD_HEIGHT, Span, Stack, find_screw_length};

/// The direction from a screw's head to its tip.
#[derive(Clone, Copy, PartialEq)]
pub enum Direction {
    Up,
    Down,
}

impl Direction {
    fn sign(self) -> f64 {
        match self {
            Self::Up => 1.0,
            Self::Down => -1.0,
        }
    }
}

/// A robot's dimensions and the bodies added so far.
pub struct Builder<'a> {
    /// Robot whose bodies are built.
    pub robot: &'a Robot,
    /// Dimensions of the robot's parts.
    pub parts: &'a Parts,
    /// Heights of the layers in which the bodies lie.
    pub stack: Stack,
    /// Positions of pivots and anchors, seen from above.
    pub layout: Layout,
    /// Bodies added so far.
    pub bodies: Vec<Body>,
}

/// A screw and the height of its nut.
pub struct Bolt<'a> {
    /// Name of the bolt, without the word "screw" or "nut".
    pub name: &'a str,
    /// Mount that the screw moves with.
    pub mount: Mount,
    /// Position of the screw's axis, mount frame, mm.
    pub position: Vector,
    /// Height of the face under the screw's head, mm.
    pub head_z: f64,
    /// Direction from the screw's head to its tip.
    pub direction: Direction,
    /// Height of the face on which the nut bears, mm.
    pub nut_z: f64,
    /// Length below the head, mm; `None` for the length that the nut needs.
    pub length: Option<f64>,
    /// Names of the bodies with other mounts that screw and nut may touch.
    pub contacts: &'a [&'a str],
    /// True for a hexagon head sunk into the part; false for a button head.
    pub is_hex: bool,
}

impl<'a> Bolt<'a> {
    /// Creates a bolt with a button head and without contacts; its nut, if any, is at height 0.
    pub fn new(
        name: &'a str,
        mount: Mount,
        position: Vector,
        head_z: f64,
        direction: Direction,
    ) -> Self {
        Self {
            name,
            mount,
            position,
            head_z,
            direction,
            nut_z: 0.0,
            length: None,
            contacts: &[],
            is_hex: false,
        }
    }
}

impl<'a> Builder<'a> {
    /// Creates a builder without bodies.
    pub fn new(robot: &'a Robot) -> Self {
        let parts = robot.parts();
        Self {
            robot,
            parts,
            stack: Stack::new(parts),
            layout: Layout::new(robot),
            bodies: Vec::new(),
        }
    }

    /// Half of a bar's width, mm.
    pub fn half_bar_width(&self) -> f64 {
        self.parts.bar / 2.0
    }

    /// Outer radius of the boss around a nut's pocket, mm, which leaves a wall at the nut's corners.
    pub fn nut_boss_radius(&self) -> f64 {
        let corner_radius = (self.parts.screw.nut + self.parts.fit) / f64::sqrt(3.0);
        self.half_bar_width().max(corner_radius + self.parts.wall)
    }

    /// Outer radius of the boss around a sunk screw head, wall included, mm.
    pub fn head_boss_radius(&self) -> f64 {
        let head_radius = self.parts.screw.head / 2.0 + self.parts.fit;
        self.half_bar_width().max(head_radius + self.parts.wall)
    }

    /// True if the struts have a slot and a spring, false if they are rigid.
    pub fn has_slotted_struts(&self) -> bool {
        self.robot.drive().strut().is_some()
    }

    /// Name of a leg's strut.
    pub fn strut_name(&self, leg: &str) -> String {
        names::strut_name(self.has_slotted_struts(), leg)
    }

    /// Makes a hole in which a screw can turn.
    pub fn clearance_hole(&self, centre: Vector) -> Shape {
        Shape::disc(
            centre,
            self.parts.screw.diameter / 2.0 + self.parts.fit / 2.0,
        )
    }

    /// Makes a hole into which a screw cuts its thread.
    pub fn thread_hole(&self, centre: Vector) -> Shape {
        Shape::disc(centre, 0.43 * self.parts.screw.diameter)
    }

    /// Makes the recess for a sunk screw head.
    pub fn head_recess(&self, centre: Vector) -> Shape {
        Shape::disc(centre, self.parts.screw.head / 2.0 + self.parts.fit)
    }

    /// Makes the pocket for a nut.
    pub fn nut_pocket(&self, centre: Vector) -> Shape {
        Shape::hexagon(centre, self.parts.screw.nut + self.parts.fit)
    }

    /// Adds a body.
    pub fn add_body(
        &mut self,
        name: impl Into<String>,
        kind: Kind,
        mount: Mount,
        prisms: impl Into<Vec<Prism>>,
    ) {
        self.bodies.push(Body {
            name: name.into(),
            kind,
            mount,
            prisms: prisms.into(),
            allowed_contacts: Vec::new(),
        });
    }

    /// Adds a printed body.
    pub fn add_printed(
        &mut self,
        name: impl Into<String>,
        mount: Mount,
        prisms: impl Into<Vec<Prism>>,
    ) {
        self.add_body(name, Kind::Printed, mount, prisms);
    }

    /// Records the bodies that the last added body touches by design.
    pub fn allow_contact<S: AsRef<str>>(&mut self, names: &[S]) {
        if let Some(body) = self.bodies.last_mut() {
            let names = names.iter().map(|name| name.as_ref().to_owned());
            body.allowed_contacts.extend(names);
        }
    }

    /// Adds a printed ring that fills the gap between two parts on a screw.
    pub fn add_spacer(
        &mut self,
        name: String,
        mount: Mount,
        centre: Vector,
        z: Span,
        contacts: &[&str],
    ) {
        let hole = self.clearance_hole(centre);
        let ring = Prism::new(
            [Shape::disc(centre, hole.radius + self.parts.wall)],
            [hole],
            z,
        );
        self.add_printed(name, mount, [ring]);
        self.allow_contact(contacts);
    }

    /// Adds a screw and its nut.
    pub fn add_bolt(&mut self, bolt: &Bolt) {
        let screw = self.parts.screw;
        let sign = bolt.direction.sign();
        let nut_end = bolt.nut_z + sign * screw.nut_height;
        let length = bolt
            .length
            .unwrap_or_else(|| find_screw_length((nut_end - bolt.head_z).abs()));
        self.add_screw(bolt, length);
        let flats = Shape::hexagon(bolt.position, screw.nut);
        let thread = Shape::disc(bolt.position, screw.diameter / 2.0);
        let nut = Prism::new([flats], [thread], order_heights(bolt.nut_z, nut_end));
        self.add_body(format!("nut {}", bolt.name), Kind::Nut, bolt.mount, [nut]);
        self.allow_contact(bolt.contacts);
    }

    /// Adds a screw without a nut.
    pub fn add_screw(&mut self, bolt: &Bolt, length: f64) {
        let screw = self.parts.screw;
        let sign = bolt.direction.sign();
        let build_prism =
            |shape: Shape, from: f64, to: f64| Prism::solid([shape], order_heights(from, to));
        let shank = Shape::disc(bolt.position, screw.diameter / 2.0);
        let (head, height, kind) = if bolt.is_hex {
            let hexagon = Shape::hexagon(bolt.position, screw.nut);
            (hexagon, HEX_HEAD_HEIGHT, Kind::HexScrew(length))
        } else {
            let disc = Shape::disc(bolt.position, screw.head / 2.0);
            (disc, screw.head_height, Kind::Screw(length))
        };
        let mut prisms = vec![
            build_prism(shank, bolt.head_z, bolt.head_z + sign * length),
            build_prism(head, bolt.head_z - sign * height, bolt.head_z),
        ];
        prisms.sort_by(|a, b| a.z[0].total_cmp(&b.z[0]));
        self.add_body(format!("screw {}", bolt.name), kind, bolt.mount, prisms);
        self.allow_contact(bolt.contacts);
    }

    /// Adds the bolt of a joint on a servo's link. A pocket in the link's underside keeps the hexagon head from
    /// turning, since no key can reach the head once the link is on its servo. `top` is the joint's upper face, mm.
    pub fn add_link_joint(
        &mut self,
        name: &str,
        mount: Mount,
        position: Vector,
        top: f64,
        contacts: &[&str],
    ) {
        self.add_bolt(&Bolt {
            nut_z: top + HEAD_PLAY,
            contacts,
            is_hex: true,
            ..Bolt::new(
                name,
                mount,
                position,
                self.stack.hex_head_face,
                Direction::Up,
            )
        });
    }
}

/// Orders two heights, lower before upper.
fn order_heights(a: f64, b: f64) -> Span {
    [a.min(b), a.max(b)]
}
