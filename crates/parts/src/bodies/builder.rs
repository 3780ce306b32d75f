//! A builder that adds a robot's bodies one by one.

use lizard_kinematics::Vector;
use lizard_robot::{Parts, Robot};

use crate::bodies::layout::Layout;
use crate::layers::body::{Body, Kind, Mount, Prism};
use crate::layers::shape::Shape;
use crate::layers::stack::{
    HEAD_CLEARANCE, HEX_HEAD_HEIGHT, Span, Stack, find_screw_length, order_heights,
};

/// The direction from a screw's head to its tip.
#[derive(Clone, Copy)]
pub enum ScrewDirection {
    Up,
    Down,
}

impl ScrewDirection {
    fn sign(self) -> f64 {
        match self {
            Self::Up => 1.0,
            Self::Down => -1.0,
        }
    }
}

/// Name of a leg's strut, slotted or rigid.
pub fn strut_name(is_slotted: bool, servo: usize) -> String {
    let prefix = if is_slotted { "" } else { "rigid " };
    format!("{prefix}{}", Mount::Strut(servo).name())
}

/// A robot's dimensions and the bodies added so far.
pub struct AssemblyBuilder<'a> {
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

/// A screw to add, with a nut or without one.
pub struct Screw {
    /// Name of the screw and of its nut, without the word "screw" or "nut".
    pub name: String,
    /// Mount that the screw moves with.
    pub mount: Mount,
    /// Position of the screw's axis, mount frame, mm.
    pub position: Vector,
    /// Height of the face under the screw's head, mm.
    pub seat_z: f64,
    /// Direction from the screw's head to its tip.
    pub direction: ScrewDirection,
    /// Names of the bodies with other mounts that screw and nut may touch.
    pub allowed_contacts: Vec<String>,
    /// True for a hexagon head sunk into the part; false for a button head.
    pub has_hex_head: bool,
}

impl Screw {
    /// Creates a screw with a button head and without allowed contacts.
    pub fn new(
        name: impl Into<String>,
        mount: Mount,
        position: Vector,
        seat_z: f64,
        direction: ScrewDirection,
    ) -> Self {
        Self {
            name: name.into(),
            mount,
            position,
            seat_z,
            direction,
            allowed_contacts: Vec::new(),
            has_hex_head: false,
        }
    }

    /// Returns the screw with one more body that screw and nut may touch.
    pub fn touching(mut self, name: impl Into<String>) -> Self {
        self.allowed_contacts.push(name.into());
        self
    }
}

impl<'a> AssemblyBuilder<'a> {
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
        // From the width across flats to the radius at the corners.
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

    /// Name of the strut between a servo and its leg.
    pub fn strut_name(&self, servo: usize) -> String {
        strut_name(self.has_slotted_struts(), servo)
    }

    /// Makes a hole in which a screw can turn.
    pub fn clearance_hole(&self, centre: Vector) -> Shape {
        let radius = self.parts.screw.diameter / 2.0 + self.parts.fit / 2.0;
        Shape::disc(centre, radius)
    }

    /// Makes a hole into which a screw cuts its thread; its diameter is 86 % of the screw's.
    pub fn pilot_hole(&self, centre: Vector) -> Shape {
        Shape::disc(centre, 0.43 * self.parts.screw.diameter)
    }

    /// Makes the counterbore for a sunk screw head.
    pub fn counterbore(&self, centre: Vector) -> Shape {
        Shape::disc(centre, self.parts.screw.head / 2.0 + self.parts.fit)
    }

    /// Makes the pocket for a nut.
    pub fn nut_pocket(&self, centre: Vector) -> Shape {
        Shape::hexagon(centre, self.parts.screw.nut + self.parts.fit)
    }

    /// Adds a body and returns it.
    pub fn add_body(
        &mut self,
        name: impl Into<String>,
        kind: Kind,
        mount: Mount,
        prisms: impl Into<Vec<Prism>>,
    ) -> &mut Body {
        self.bodies.push_mut(Body {
            name: name.into(),
            kind,
            mount,
            prisms: prisms.into(),
            allowed_contacts: Vec::new(),
        })
    }

    /// Adds the printed body of a mount, under the mount's name, and returns it.
    pub fn add_printed(&mut self, mount: Mount, prisms: impl Into<Vec<Prism>>) -> &mut Body {
        self.add_body(mount.name(), Kind::Printed, mount, prisms)
    }

    /// Adds a printed ring that fills the gap between two parts on a screw.
    pub fn add_spacer(
        &mut self,
        name: String,
        mount: Mount,
        centre: Vector,
        z: Span,
        allowed_contact: &str,
    ) {
        let hole = self.clearance_hole(centre);
        let disc = Shape::disc(centre, hole.radius + self.parts.wall);
        let ring = Prism::new([disc], [hole], z);
        let spacer = self.add_body(name, Kind::Printed, mount, [ring]);
        spacer.allowed_contacts = vec![allowed_contact.to_owned()];
    }

    /// Adds a bolt: a screw that is long enough for its nut, and the nut. `nut_z` is the height of the face on which
    /// the nut bears, mm.
    pub fn add_bolt(&mut self, screw: &Screw, nut_z: f64) {
        let nut_end = nut_z + screw.direction.sign() * self.parts.screw.nut_height;
        self.add_screw(screw, find_screw_length((nut_end - screw.seat_z).abs()));
        self.add_nut(screw, nut_z);
    }

    /// Adds the nut of a screw. `nut_z` is the height of the face on which the nut bears, mm.
    pub fn add_nut(&mut self, screw: &Screw, nut_z: f64) {
        let nut_end = nut_z + screw.direction.sign() * self.parts.screw.nut_height;
        let prism = self.make_nut(screw.position, order_heights(nut_z, nut_end));
        let nut = self.add_body(
            format!("nut {}", screw.name),
            Kind::Nut,
            screw.mount,
            [prism],
        );
        nut.allowed_contacts.clone_from(&screw.allowed_contacts);
    }

    /// Makes the layer of a nut.
    pub fn make_nut(&self, position: Vector, z: Span) -> Prism {
        let hexagon = Shape::hexagon(position, self.parts.screw.nut);
        let thread = Shape::disc(position, self.parts.screw.diameter / 2.0);
        Prism::new([hexagon], [thread], z)
    }

    /// Adds a screw without a nut; `length` is its length below the head, mm.
    pub fn add_screw(&mut self, screw: &Screw, length: f64) {
        let (size, seat_z) = (self.parts.screw, screw.seat_z);
        let direction = screw.direction.sign();
        let shank = Shape::disc(screw.position, size.diameter / 2.0);
        let (head, height, kind) = if screw.has_hex_head {
            let hexagon = Shape::hexagon(screw.position, size.nut);
            (hexagon, HEX_HEAD_HEIGHT, Kind::HexScrew(length))
        } else {
            let disc = Shape::disc(screw.position, size.head / 2.0);
            (disc, size.head_height, Kind::Screw(length))
        };
        let mut prisms = vec![
            Prism::solid([shank], order_heights(seat_z, seat_z + direction * length)),
            Prism::solid([head], order_heights(seat_z - direction * height, seat_z)),
        ];
        prisms.sort_by(|a, b| a.z[0].total_cmp(&b.z[0]));
        let body = self.add_body(format!("screw {}", screw.name), kind, screw.mount, prisms);
        body.allowed_contacts.clone_from(&screw.allowed_contacts);
    }

    /// Adds the bolt of a joint on a servo's link. A pocket in the link's underside keeps the hexagon head from
    /// turning, since no wrench can reach the head once the link is on its servo. `top` is the joint's upper face, mm.
    pub fn add_link_joint(
        &mut self,
        name: String,
        mount: Mount,
        position: Vector,
        top: f64,
        allowed_contact: &str,
    ) {
        let seat_z = self.stack.hex_head_face;
        let mut screw = Screw::new(name, mount, position, seat_z, ScrewDirection::Up);
        screw.has_hex_head = true;
        self.add_bolt(&screw.touching(allowed_contact), top + HEAD_CLEARANCE);
    }
}
