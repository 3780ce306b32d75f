//! The tree of bodies, each with the joint to its parent.

use lizard_robot::SLOT;
use lizard_robot::servo::LEGS;

use super::inertia::Inertia;
use super::node::{Moves, Node};
use super::scene::{Motor, Pull};
use super::text::{MILLI, metres, round};
use super::writer::{Writer, colour, limits};
use crate::bill::{self, Bill};
use crate::layers::body::Mount;
use crate::layers::placement::Placement;

/// Damping of a foot on its leaf, as a share of the critical damping of a quarter of the
/// robot's mass.
const DAMPING: f64 = 0.4;
/// Radius of a pad, mm: that of the post above it.
const PAD: f64 = 5.0;
/// Time constant of a servo's rotor without load, s. Through the gears it is far harder to
/// turn than a leg, so it smooths the steps of the pulses.
const SPIN_UP: f64 = 0.02;
/// kg m^2 per g mm^2.
const MILLI_CUBED: f64 = 1e-9;

impl Writer<'_> {
    pub(super) fn body(&mut self, node: Node) {
        let stack = *self.assembly.stack();
        let parent = node.parent(self.plays());
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
        let mass = own.fold(self.loose(node), |sum, piece| sum.and(&piece.inertia));
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
            let foot = self.assembly.layout().legs[servo].foot;
            let z = stack.floor - self.scene.long[servo] + PAD;
            let (leg, at) = (LEGS[servo], metres([foot.x, foot.y, z]));
            let (size, contact) = (round(PAD * MILLI), self.contact());
            self.xml.leaf(format!(
                r#"geom name="pad {leg}" type="sphere" size="{size}" pos="{at}" rgba="0.15 0.15 0.15 1" contype="1" {contact}"#
            ));
        }
        if parent.is_none() {
            self.xml.leaf(
                r#"camera name="beside" mode="trackcom" pos="0.24 -0.21 0.2" xyaxes="0.66 0.75 0 -0.39 0.34 0.86""#,
            );
        }
        for child in Node::all(self.scene.pull.is_some(), self.plays()) {
            if child.parent(self.plays()) == Some(node) {
                self.body(child);
            }
        }
        self.xml.close();
    }

    /// The mass of things on the bill that are not drawn, such as wires, put into the plate's
    /// middle.
    pub(super) fn loose(&self, node: Node) -> Inertia {
        if node != Node::Of(Mount::Chassis) {
            return Inertia::default();
        }
        let all = Bill::of(self.assembly, &[], self.neutral).grams;
        let bodies = self.assembly.bodies().iter();
        let drawn: f64 = bodies.map(|body| bill::grams(body, self.assembly)).sum();
        Inertia::point((all - drawn).max(0.0))
    }

    /// Writes the joint of a body with its parent, under the body's name.
    pub(super) fn joint(&mut self, node: Node) {
        let name = node.name();
        let (kind, axis) = match node.moves() {
            Moves::Free => {
                self.xml.leaf(format!(r#"freejoint name="{name}""#));
                return;
            }
            Moves::Turns => ("hinge", "0 0 1"),
            Moves::Along => ("slide", "1 0 0"),
            Moves::Upright => ("slide", "0 0 1"),
        };
        let mut joint = format!(r#"joint name="{name}" type="{kind}" axis="{axis}""#);
        if self.motor_on(node).is_some() {
            // The motor's own voltage takes from its torque as it turns faster.
            let Motor { rate, stall } = self.scene.motor;
            let damping = stall * MILLI / rate.to_radians();
            let (damping, armature) = (round(damping), round(damping * SPIN_UP));
            joint += &format!(r#" damping="{damping}" armature="{armature}""#);
        }
        match (node, self.scene.pull) {
            (Node::Of(Mount::Link(_)), _) if self.plays() => {
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
            Node::Of(Mount::Link(servo)) if !self.plays() => Some(servo),
            _ => None,
        }
    }
}
