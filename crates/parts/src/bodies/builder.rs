//! Bodies are added one by one; screws bring their nuts.

use lizard_kinematics::Vector;
use lizard_robot::{Parts, Robot};

use crate::bodies::layout::Layout;
use crate::bodies::names;
use crate::layers::body::{Body, Kind, Mount, Prism};
use crate::layers::shape::Shape;
use crate::layers::stack::{HEX, PLAY, Span, Stack, screw_length};

/// Which way a screw points.
#[derive(Clone, Copy, PartialEq)]
pub enum Points {
    Up,
    Down,
}

/// What the assembly is built with.
pub struct Builder<'a> {
    pub robot: &'a Robot,
    pub parts: &'a Parts,
    pub stack: Stack,
    pub layout: Layout,
    pub bodies: Vec<Body>,
}

/// A screw with a nut.
pub struct Bolt<'a> {
    pub name: &'a str,
    /// What it turns with.
    pub mount: Mount,
    pub at: Vector,
    /// Where the head bears.
    pub head: f64,
    pub points: Points,
    /// What the nut bears on.
    pub nut: f64,
    /// Length below the head; else as long as the nut needs.
    pub length: Option<f64>,
    /// What it passes through.
    pub meets: &'a [&'a str],
    /// Whether its head is a hexagon, sunk into what it is put into.
    pub hex: bool,
}

impl<'a> Builder<'a> {
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

    /// Half a bar's width, mm.
    pub fn half(&self) -> f64 {
        self.parts.bar / 2.0
    }

    /// Radius of what is around a pocket for a nut, so that its corners have a wall, mm.
    pub fn eye(&self) -> f64 {
        let corner = (self.parts.screw.nut + self.parts.fit) / f64::sqrt(3.0);
        self.half().max(corner + self.parts.wall)
    }

    /// The same around a head that is sunk, mm.
    pub fn around_head(&self) -> f64 {
        let head = self.parts.screw.head / 2.0 + self.parts.fit;
        self.half().max(head + self.parts.wall)
    }

    /// Whether the struts have a slot and a spring.
    pub fn slotted(&self) -> bool {
        self.robot.drive().strut().is_some()
    }

    /// The name of a leg's strut.
    pub fn strut(&self, leg: &str) -> String {
        names::strut(self.slotted(), leg)
    }

    /// A hole through which a screw turns.
    pub fn hole(&self, at: Vector) -> Shape {
        Shape::disc(at, self.parts.screw.diameter / 2.0 + self.parts.fit / 2.0)
    }

    /// A hole into which a screw cuts its thread.
    pub fn thread(&self, at: Vector) -> Shape {
        Shape::disc(at, 0.43 * self.parts.screw.diameter)
    }

    /// What a screw's head is sunk into.
    pub fn sink(&self, at: Vector) -> Shape {
        Shape::disc(at, self.parts.screw.head / 2.0 + self.parts.fit)
    }

    /// What a nut is sunk into.
    pub fn pocket(&self, at: Vector) -> Shape {
        Shape::hexagon(at, self.parts.screw.nut + self.parts.fit)
    }

    pub fn body(&mut self, name: String, kind: Kind, mount: Mount, prisms: Vec<Prism>) {
        self.bodies.push(Body {
            name,
            kind,
            mount,
            prisms,
            meets: Vec::new(),
        });
    }

    /// That the last body touches another by design.
    pub fn meeting(&mut self, name: &str) {
        if let Some(body) = self.bodies.last_mut() {
            body.meets.push(name.to_owned());
        }
    }

    /// A printed ring around a screw.
    pub fn spacer(&mut self, name: String, mount: Mount, at: Vector, z: Span, meets: &[&str]) {
        let hole = self.hole(at);
        let ring = Prism {
            add: vec![Shape::disc(at, hole.radius + self.parts.wall)],
            cut: vec![hole],
            z,
        };
        self.body(name, Kind::Printed, mount, vec![ring]);
        for other in meets {
            self.meeting(other);
        }
    }

    /// A screw and its nut.
    pub fn bolt(&mut self, bolt: &Bolt) {
        let screw = self.parts.screw;
        let way = match bolt.points {
            Points::Up => 1.0,
            Points::Down => -1.0,
        };
        let behind = bolt.nut + way * screw.nut_height;
        let length = bolt
            .length
            .unwrap_or_else(|| screw_length((behind - bolt.head).abs()));
        self.screw(bolt, length);
        let nut = Prism {
            add: vec![Shape::hexagon(bolt.at, screw.nut)],
            cut: vec![Shape::disc(bolt.at, screw.diameter / 2.0)],
            z: ordered(bolt.nut, behind),
        };
        self.body(
            format!("nut {}", bolt.name),
            Kind::Nut,
            bolt.mount,
            vec![nut],
        );
        self.meet(bolt.meets);
    }

    /// A screw without a nut.
    pub fn screw(&mut self, bolt: &Bolt, length: f64) {
        let screw = self.parts.screw;
        let way = match bolt.points {
            Points::Up => 1.0,
            Points::Down => -1.0,
        };
        let prism = |shape: Shape, from: f64, to: f64| Prism {
            add: vec![shape],
            cut: Vec::new(),
            z: ordered(from, to),
        };
        let shank = Shape::disc(bolt.at, screw.diameter / 2.0);
        let (head, high, kind) = if bolt.hex {
            let hexagon = Shape::hexagon(bolt.at, screw.nut);
            (hexagon, HEX, Kind::HexScrew(length))
        } else {
            let disc = Shape::disc(bolt.at, screw.head / 2.0);
            (disc, screw.head_height, Kind::Screw(length))
        };
        let mut prisms = vec![
            prism(shank, bolt.head, bolt.head + way * length),
            prism(head, bolt.head - way * high, bolt.head),
        ];
        prisms.sort_by(|a, b| a.z[0].total_cmp(&b.z[0]));
        self.body(format!("screw {}", bolt.name), kind, bolt.mount, prisms);
        self.meet(bolt.meets);
    }

    fn meet(&mut self, names: &[&str]) {
        for name in names {
            self.meeting(name);
        }
    }

    /// A joint of two or more parts, held from below; the nut is above all.
    pub fn joint(&mut self, name: &str, mount: Mount, at: Vector, z: Span, meets: &[&str]) {
        self.bolt(&Bolt {
            name,
            mount,
            at,
            head: z[0],
            points: Points::Up,
            nut: z[1] + PLAY,
            length: None,
            meets,
            hex: false,
        });
    }

    /// A joint on a servo's link, whose underside holds the screw's head: no key gets
    /// there once the link is on its servo.
    pub fn held_joint(&mut self, name: &str, mount: Mount, at: Vector, top: f64, meets: &[&str]) {
        self.bolt(&Bolt {
            name,
            mount,
            at,
            head: self.stack.held,
            points: Points::Up,
            nut: top + PLAY,
            length: None,
            meets,
            hex: true,
        });
    }
}

/// Two heights, the lower one first.
fn ordered(a: f64, b: f64) -> Span {
    [a.min(b), a.max(b)]
}
