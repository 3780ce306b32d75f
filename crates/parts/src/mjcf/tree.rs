//! The tree of bodies, each with the joint to its parent.

use lizard_robot::SLOT;

use super::inertia::Inertia;
use super::node::{Freedom, Node};
use super::scene::Pull;
use super::text::{MILLI, metres, round};
use super::writer::{Writer, colour, limits};
use crate::bill::{self, Bill};
use crate::layers::body::Mount;
use crate::layers::placement::Placement;

/// Damping of a foot on its leaf, as a share of the critical damping of a quarter of the
/// robot's mass.
const DAMPING: f64 = 0.4;
/// kg m^2 per g mm^2.
const MILLI_CUBED: f64 = 1e-9;

impl Writer<'_> {
    pub(super) fn body(&mut self, node: Node) {
        let stack = *self.assembly.stack();
        let parent = node.parent(self.has_play());
        let place = match parent {
            Some(parent) => self.place(node).seen_from(&self.place(parent)),
            None => Placement::CHASSIS,
        };
        // The pads' undersides are on the floor, the longest foot's too.
        let longest = self.scene.long.into_iter().fold(0.0, f64::max);
        let up = match parent {
            Some(_) => 0.0,
            None => longest - stack.floor,
        };
        let half = place.turn.angle().to_radians() / 2.0;
        let (name, at) = (node.name(), metres([place.at.x, place.at.y, up]));
        let (cos, sin) = (round(half.cos()), round(half.sin()));
        self.xml.open(format!(
            r#"body name="{name}" pos="{at}" quat="{cos} 0 0 {sin}""#
        ));
        self.joint(node);
        let own = self.pieces.iter().filter(|piece| piece.node == node);
        let drawn = own.fold(Inertia::default(), |sum, piece| sum.and(&piece.inertia));
        let mass = match parent {
            Some(_) => drawn,
            None => self.weighed(&drawn),
        };
        let (centre, grams) = (metres(mass.centre()), round(mass.mass * MILLI));
        let tensor = mass
            .tensor()
            .map(|part| format!("{:.6e}", part * MILLI_CUBED));
        let tensor = tensor.join(" ");
        self.xml.leaf(format!(
            r#"inertial pos="{centre}" mass="{grams}" fullinertia="{tensor}""#
        ));
        for piece in self.shown().iter().filter(|piece| piece.node == node) {
            let (name, colour) = (&piece.name, colour(piece.kind));
            self.xml
                .leaf(format!(r#"geom type="mesh" mesh="{name}" rgba="{colour}""#));
        }
        if let Node::Pad(servo) = node {
            self.pad(servo);
        }
        if parent.is_none() {
            self.xml.leaf(
                r#"camera name="beside" mode="trackcom" pos="0.24 -0.21 0.2" xyaxes="0.66 0.75 0 -0.39 0.34 0.86""#,
            );
        }
        for child in Node::all(self.scene.pull.is_some(), self.has_play()) {
            if child.parent(self.has_play()) == Some(node) {
                self.body(child);
            }
        }
        self.xml.close();
    }

    /// The chassis of a robot that has the mass and the mass centre of `[body]`. What is not
    /// drawn, such as wires, is in the plate's middle; then its parts are moved together.
    fn weighed(&self, drawn: &Inertia) -> Inertia {
        let body = self.assembly.robot().ground().body;
        let bill = Bill::of(self.assembly, &[], self.neutral);
        let bodies = self.assembly.bodies().iter();
        let parts: f64 = bodies.map(|body| bill::grams(body, self.assembly)).sum();
        // For a robot that is lighter than its parts, half of the chassis stays.
        let loose = (body.mass - parts).max(-drawn.mass / 2.0);
        let chassis = drawn.and(&Inertia::point(loose));
        let [ahead, left] =
            [0, 1].map(|i| body.mass * body.centre[i] - bill.grams * bill.centre[i]);
        chassis.moved([-left, ahead, 0.0].map(|moment| moment / chassis.mass))
    }

    /// Writes the joint of a body with its parent, under the body's name.
    pub(super) fn joint(&mut self, node: Node) {
        let name = node.name();
        let (kind, axis) = match node.freedom() {
            Freedom::Free => {
                self.xml.leaf(format!(r#"freejoint name="{name}""#));
                return;
            }
            Freedom::Turns => ("hinge", "0 0 1"),
            Freedom::Along => ("slide", "1 0 0"),
            Freedom::Upright => ("slide", "0 0 1"),
        };
        let mut joint = format!(r#"joint name="{name}" type="{kind}" axis="{axis}""#);
        let joints = self.scene.motors.joints;
        if let Some(servo) = self.motor_on(node) {
            // The motor's own voltage takes from its torque as it turns faster. Through the gears
            // its rotor is far harder to turn than a leg, so it smooths the steps of the pulses.
            let motor = self.scene.motors.each[servo];
            let damping = round(motor.damping() * MILLI);
            let armature = round(motor.inertia() * MILLI);
            joint += &format!(r#" damping="{damping}" armature="{armature}""#);
            joint += &friction_loss(joints.drag * MILLI);
        } else if matches!(node.freedom(), Freedom::Turns) {
            joint += &friction_loss(self.scene.pins * MILLI);
        }
        if matches!(node.freedom(), Freedom::Along) && !matches!(node, Node::Slot(_)) {
            joint += &friction_loss(joints.slider);
        }
        match (node, self.scene.pull) {
            (Node::Of(Mount::Link(_)), _) if self.has_play() => {
                let (play, limits) = (round(self.scene.play.to_radians()), limits());
                // Grease: a link that is free in its play does not ring.
                joint += &format!(r#" range="{} {play}" {limits} damping="0.00001""#, -play);
            }
            (Node::Pad(_), _) => {
                let stiffness = self.scene.stiffness / MILLI;
                let quarter = self.assembly.robot().ground().body.mass * MILLI / 4.0;
                let damping = round(DAMPING * 2.0 * (stiffness * quarter).sqrt());
                let stiffness = round(stiffness);
                joint += &format!(r#" stiffness="{stiffness}" damping="{damping}""#);
            }
            (Node::Slot(_), Some(Pull { force, rate })) => {
                let (end, limits) = (round(SLOT * MILLI), limits());
                let (stiffness, rest) = (round(rate / MILLI), round(-force / rate * MILLI));
                joint += &format!(
                    r#" range="0 {end}" {limits} stiffness="{stiffness}" springref="{rest}" damping="0.1""#
                );
            }
            _ => {}
        }
        self.xml.leaf(joint);
    }

    /// The servo whose motor turns a body, if any.
    pub(super) fn motor_on(&self, node: Node) -> Option<usize> {
        match node {
            Node::Horn(servo) => Some(servo),
            Node::Of(Mount::Link(servo)) if !self.has_play() => Some(servo),
            _ => None,
        }
    }
}

/// The attribute of a joint's dry friction, N or N m; none without.
fn friction_loss(friction: f64) -> String {
    match friction > 0.0 {
        true => format!(r#" frictionloss="{}""#, round(friction)),
        false => String::new(),
    }
}
