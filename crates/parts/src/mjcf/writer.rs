//! The file from the top: options, defaults, meshes, floor, and then the robot.

use lizard_kinematics::Solution;

use super::node::Node;
use super::pieces::Piece;
use super::scene::Scene;
use super::text::{Xml, escaped, round};
use crate::bodies::assembly::Assembly;
use crate::layers::body::{Kind, Mount};
use crate::layers::placement::Placement;

/// Time of a step, s.
const STEP: f64 = 0.0002;
/// Stiffness of constraints and contacts: time constant, s, and damping ratio. A soft floor
/// would hide part of a foot's excess length.
const HARD: &str = "0.002 1";
pub(super) const CONTACT: &str = "0.001 1";
/// Impedance of constraints and limits.
const STIFF: &str = "0.99 0.999 0.0001";

/// A writer of a robot and its scene.
pub(super) struct Writer<'a> {
    pub assembly: &'a Assembly,
    pub neutral: &'a Solution,
    pub scene: &'a Scene,
    pub pieces: &'a [Piece],
    pub xml: Xml,
}

impl<'a> Writer<'a> {
    pub(super) fn document(&mut self) {
        let name = escaped(&self.scene.name);
        self.xml.open(format!(r#"mujoco model="{name}""#));
        self.options();
        self.xml.open("custom");
        let ratio = round(self.scene.ratio);
        let data = format!(r#"numeric name="back over forward" data="{ratio}""#);
        self.xml.leaf(data);
        if let Some(course) = &self.scene.course {
            let (begin, period) = (round(course.begin), round(course.period));
            let count = course.count;
            let data = format!(r#"numeric name="cycle" data="{begin} {period} {count}""#);
            self.xml.leaf(data);
        }
        self.xml.close();
        self.assets();
        self.world();
        self.loops();
        self.actuators();
        self.course();
    }

    fn options(&mut self) {
        let xml = &mut self.xml;
        xml.leaf(r#"compiler angle="radian" autolimits="true""#);
        // Feet of a few g chatter on the default contacts.
        xml.leaf(format!(
            r#"option timestep="{STEP}" gravity="{}" integrator="implicitfast" cone="elliptic" impratio="100" noslip_iterations="20""#,
            self.scene.floor.gravity()
        ));
        xml.open("visual");
        xml.leaf(r#"map znear="0.01""#);
        xml.leaf(r#"global offwidth="1280" offheight="960""#);
        xml.close();
        xml.leaf(r#"statistic extent="0.3" center="0 0 0.03""#);
        xml.open("default");
        xml.leaf(r#"geom contype="0" conaffinity="0""#);
        xml.leaf(r#"mesh scale="0.001 0.001 0.001""#);
        xml.leaf(format!(r#"equality solref="{HARD}" solimp="{STIFF}""#));
        xml.close();
    }

    fn assets(&mut self) {
        const SIZE: &str = r#"width="256" height="256""#;
        let shown = self.shown();
        let xml = &mut self.xml;
        xml.open("asset");
        xml.leaf(format!(
            r#"texture name="sky" type="skybox" builtin="gradient" rgb1="0.9 0.95 1" rgb2="0.6 0.7 0.8" {SIZE}"#
        ));
        xml.leaf(format!(
            r#"texture name="floor" type="2d" builtin="checker" rgb1="0.75 0.75 0.72" rgb2="0.82 0.82 0.8" {SIZE}"#
        ));
        // A square is 5 cm wide.
        xml.leaf(r#"material name="floor" texture="floor" texrepeat="10 10" texuniform="true""#);
        for Piece { name, mesh, .. } in shown {
            let corners = mesh.corners.as_flattened().iter();
            let vertex = corners.map(|part| (part * 1e5).round() / 1e5 + 0.0);
            let face = mesh.triangles.as_flattened().iter();
            let (vertex, face) = (joined(vertex), joined(face));
            xml.leaf(format!(
                r#"mesh name="{name}" vertex="{vertex}" face="{face}""#
            ));
        }
        xml.close();
    }

    fn world(&mut self) {
        self.xml.open("worldbody");
        self.xml
            .leaf(r#"light pos="0.3 -0.3 1" dir="-0.3 0.3 -1" type="directional""#);
        self.floor();
        self.body(Node::Of(Mount::Chassis));
        self.xml.close();
    }

    /// The parts whose shapes go into the file.
    pub(super) fn shown(&self) -> &'a [Piece] {
        match self.scene.shapes {
            true => self.pieces,
            false => &[],
        }
    }

    /// True if the links have play on their horns.
    pub(super) fn has_play(&self) -> bool {
        self.scene.play > 0.0
    }

    pub(super) fn place(&self, node: Node) -> Placement {
        self.assembly.place(node.frame(), self.neutral)
    }
}

/// The attributes that make the ends of a joint's range hard.
pub(super) fn limits() -> String {
    format!(r#"solreflimit="{HARD}" solimplimit="{STIFF}""#)
}

/// Numbers with blanks between them.
pub(super) fn joined(numbers: impl IntoIterator<Item = impl ToString>) -> String {
    let numbers: Vec<_> = numbers
        .into_iter()
        .map(|number| number.to_string())
        .collect();
    numbers.join(" ")
}

pub(super) fn colour(kind: Kind) -> &'static str {
    match kind {
        Kind::Printed => "0.36 0.62 0.36 1",
        Kind::Servo => "0.15 0.3 0.65 1",
        Kind::Horn => "0.95 0.95 0.95 1",
        Kind::Board => "0.0 0.5 0.55 1",
        Kind::Battery => "0.25 0.25 0.28 1",
        Kind::Pad => "0.15 0.15 0.15 1",
        _ => "0.6 0.6 0.62 1",
    }
}
