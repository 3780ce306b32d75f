//! The file from the top: options, defaults, meshes, floor, and then the robot.

use std::fmt::Write as _;

use lizard_kinematics::Solution;
use lizard_robot::GRAVITY;
use xmlwriter::XmlWriter;

use super::node::Node;
use super::pieces::Piece;
use super::scene::Scene;
use super::text::{escaped, round};
use crate::bodies::assembly::Assembly;
use crate::layers::body::{Kind, Mount};
use crate::layers::placement::Placement;

/// Time of a step, s.
const STEP: f64 = 0.0002;
pub(super) const FIRM: &str = "0.95 0.99 0.0005";
/// How hard constraints and contacts are, s and damping ratio. A floor that gives would take
/// a part of what a foot is too long.
const HARD: &str = "0.002 1";
pub(super) const CONTACT: &str = "0.001 1";

/// What writes a robot and its scene.
pub(super) struct Writer<'a> {
    pub assembly: &'a Assembly,
    pub neutral: &'a Solution,
    pub scene: &'a Scene,
    pub pieces: &'a [Piece],
    pub xml: XmlWriter,
}

impl<'a> Writer<'a> {
    /// An element without children.
    pub(super) fn element(&mut self, name: &str, attributes: &[(&str, String)]) {
        self.open(name, attributes);
        self.xml.end_element();
    }

    pub(super) fn open(&mut self, name: &str, attributes: &[(&str, String)]) {
        self.xml.start_element(name);
        for (name, value) in attributes {
            self.xml.write_attribute(name, &escaped(value));
        }
    }

    pub(super) fn document(&mut self) {
        self.open("mujoco", &[("model", self.scene.name.clone())]);
        self.element(
            "compiler",
            &[
                ("angle", "radian".to_owned()),
                ("autolimits", "true".to_owned()),
            ],
        );
        self.element(
            "option",
            &[
                ("timestep", STEP.to_string()),
                ("gravity", format!("0 0 {}", -GRAVITY)),
                ("integrator", "implicitfast".to_owned()),
                // Feet of a few g chatter on the default contacts.
                ("cone", "elliptic".to_owned()),
                ("impratio", "100".to_owned()),
                ("noslip_iterations", "20".to_owned()),
            ],
        );
        self.open("visual", &[]);
        self.element("map", &[("znear", "0.01".to_owned())]);
        self.element(
            "global",
            &[
                ("offwidth", "1280".to_owned()),
                ("offheight", "960".to_owned()),
            ],
        );
        self.xml.end_element();
        self.element(
            "statistic",
            &[
                ("extent", "0.3".to_owned()),
                ("center", "0 0 0.03".to_owned()),
            ],
        );
        self.defaults();
        if let Some(course) = &self.scene.course {
            self.open("custom", &[]);
            let data = format!("{} {}", round(course.begin), round(course.period));
            self.element("numeric", &[("name", "cycle".to_owned()), ("data", data)]);
            self.xml.end_element();
        }
        self.assets();
        self.world();
        self.loops();
        self.actuators();
        self.course();
    }

    pub(super) fn defaults(&mut self) {
        self.open("default", &[]);
        self.element(
            "geom",
            &[("contype", "0".to_owned()), ("conaffinity", "0".to_owned())],
        );
        self.element("mesh", &[("scale", "0.001 0.001 0.001".to_owned())]);
        self.element(
            "equality",
            &[
                ("solref", HARD.to_owned()),
                ("solimp", "0.99 0.999 0.0001".to_owned()),
            ],
        );
        self.xml.end_element();
    }

    pub(super) fn assets(&mut self) {
        self.open("asset", &[]);
        let texture = |name: &str, kind: &str, from: &str, to: &str| {
            vec![
                ("name", name.to_owned()),
                ("type", kind.to_owned()),
                (
                    "builtin",
                    if kind == "2d" { "checker" } else { "gradient" }.to_owned(),
                ),
                ("rgb1", from.to_owned()),
                ("rgb2", to.to_owned()),
                ("width", "256".to_owned()),
                ("height", "256".to_owned()),
            ]
        };
        self.element(
            "texture",
            &texture("sky", "skybox", "0.9 0.95 1", "0.6 0.7 0.8"),
        );
        self.element(
            "texture",
            &texture("floor", "2d", "0.75 0.75 0.72", "0.82 0.82 0.8"),
        );
        self.element(
            "material",
            &[
                ("name", "floor".to_owned()),
                ("texture", "floor".to_owned()),
                // A square is 5 cm wide.
                ("texrepeat", "10 10".to_owned()),
                ("texuniform", "true".to_owned()),
            ],
        );
        for piece in self.shown() {
            let mut vertex = String::new();
            for corner in &piece.mesh.corners {
                let [x, y, z] = corner.map(|part| (part * 1e5).round() / 1e5 + 0.0);
                _ = write!(vertex, "{x} {y} {z} ");
            }
            let mut face = String::new();
            for [a, b, c] in &piece.mesh.triangles {
                _ = write!(face, "{a} {b} {c} ");
            }
            self.element(
                "mesh",
                &[
                    ("name", piece.name.clone()),
                    ("vertex", vertex.trim_end().to_owned()),
                    ("face", face.trim_end().to_owned()),
                ],
            );
        }
        self.xml.end_element();
    }

    pub(super) fn world(&mut self) {
        self.open("worldbody", &[]);
        self.element(
            "light",
            &[
                ("pos", "0.3 -0.3 1".to_owned()),
                ("dir", "-0.3 0.3 -1".to_owned()),
                ("type", "directional".to_owned()),
            ],
        );
        self.element(
            "geom",
            &[
                ("name", "floor".to_owned()),
                ("type", "plane".to_owned()),
                ("size", "0 0 0.05".to_owned()),
                ("material", "floor".to_owned()),
                ("conaffinity", "1".to_owned()),
                ("condim", "3".to_owned()),
                ("friction", self.friction()),
                ("solref", CONTACT.to_owned()),
                ("solimp", FIRM.to_owned()),
            ],
        );
        self.body(Node::Of(Mount::Chassis));
        self.xml.end_element();
    }

    /// The parts that can be seen.
    pub(super) fn shown(&self) -> &'a [Piece] {
        match self.scene.shapes {
            true => self.pieces,
            false => &[],
        }
    }

    /// A pad's: it slides, and neither turns nor rolls against a friction of its own.
    pub(super) fn friction(&self) -> String {
        format!("{} 0 0", self.assembly.robot().ground().friction)
    }

    pub(super) fn plays(&self) -> bool {
        self.scene.play > 0.0
    }

    pub(super) fn place(&self, node: Node) -> Placement {
        self.assembly.place(node.frame(), self.neutral)
    }
}

pub(super) fn limits() -> [(&'static str, String); 2] {
    [
        ("solreflimit", HARD.to_owned()),
        ("solimplimit", "0.99 0.999 0.0001".to_owned()),
    ]
}

pub(super) fn colour(kind: Kind) -> &'static str {
    match kind {
        Kind::Printed => "0.36 0.62 0.36 1",
        Kind::Servo => "0.15 0.3 0.65 1",
        Kind::Horn => "0.95 0.95 0.95 1",
        Kind::Board => "0.0 0.5 0.55 1",
        Kind::Battery => "0.25 0.25 0.28 1",
        _ => "0.6 0.6 0.62 1",
    }
}
