//! The tree of bodies, and the joint of each with the one that carries it.

use lizard_robot::SLOT;
use lizard_robot::servo::LEGS;

use super::inertia::Inertia;
use super::node::{Moves, Node};
use super::scene::{Motor, Pull};
use super::text::{MILLI, metres, round};
use super::writer::{CONTACT, FIRM, Writer, colour, limits};
use crate::bill::{self, Bill};
use crate::layers::body::Mount;
use crate::layers::placement::Placement;

/// Damping of a foot on its leaf over the critical one of a quarter of the robot.
const DAMPING: f64 = 0.4;
/// Radius of a pad, mm: that of the post above it.
const PAD: f64 = 5.0;
/// What a servo's rotor takes to come to its speed without load, s. Behind its gears it is
/// far heavier to turn than a leg, and so smooths the steps of its pulses.
const SPIN_UP: f64 = 0.02;
/// kg m^2 in a g mm^2.
const MILLI_CUBED: f64 = 1e-9;

impl Writer<'_> {
    pub(super) fn body(&mut self, node: Node) {
        let stack = *self.assembly.stack();
        let carrier = node.carrier(self.plays());
        let place = match carrier {
            Some(carrier) => self.place(node).seen_from(&self.place(carrier)),
            None => Placement::CHASSIS,
        };
        // The pads' undersides are on the floor, the longest foot's too.
        let longest = self.scene.long.into_iter().fold(0.0, f64::max);
        let up = match carrier {
            Some(_) => 0.0,
            None => longest - stack.floor,
        };
        let half = place.turn.angle().to_radians() / 2.0;
        self.open(
            "body",
            &[
                ("name", node.name()),
                ("pos", metres([place.at.x, place.at.y, up])),
                (
                    "quat",
                    format!("{} 0 0 {}", round(half.cos()), round(half.sin())),
                ),
            ],
        );
        self.joint(node);
        let mass = self
            .pieces
            .iter()
            .filter(|piece| piece.node == node)
            .fold(self.loose(node), |sum, piece| sum.and(&piece.inertia));
        let tensor = mass
            .tensor()
            .map(|part| format!("{:.6e}", part * MILLI_CUBED));
        self.element(
            "inertial",
            &[
                ("pos", metres(mass.centre())),
                ("mass", round(mass.mass * MILLI).to_string()),
                ("fullinertia", tensor.join(" ")),
            ],
        );
        for piece in self.shown().iter().filter(|piece| piece.node == node) {
            self.element(
                "geom",
                &[
                    ("type", "mesh".to_owned()),
                    ("mesh", piece.name.clone()),
                    ("rgba", colour(piece.kind).to_owned()),
                ],
            );
        }
        if let Node::Pad(servo) = node {
            let foot = self.assembly.layout().legs[servo].foot;
            let z = stack.floor - self.scene.long[servo] + PAD;
            self.element(
                "geom",
                &[
                    ("name", format!("pad {}", LEGS[servo])),
                    ("type", "sphere".to_owned()),
                    ("size", round(PAD * MILLI).to_string()),
                    ("pos", metres([foot.x, foot.y, z])),
                    ("rgba", "0.15 0.15 0.15 1".to_owned()),
                    ("contype", "1".to_owned()),
                    ("condim", "3".to_owned()),
                    ("friction", self.friction()),
                    ("solref", CONTACT.to_owned()),
                    ("solimp", FIRM.to_owned()),
                ],
            );
        }
        if carrier.is_none() {
            self.element(
                "camera",
                &[
                    ("name", "beside".to_owned()),
                    ("mode", "trackcom".to_owned()),
                    ("pos", "0.24 -0.21 0.2".to_owned()),
                    ("xyaxes", "0.66 0.75 0 -0.39 0.34 0.86".to_owned()),
                ],
            );
        }
        for child in Node::all(self.scene.pull.is_some(), self.plays()) {
            if child.carrier(self.plays()) == Some(node) {
                self.body(child);
            }
        }
        self.xml.end_element();
    }

    /// What the bill weighs and no body is drawn of, such as wires: it is taken to be in the
    /// plate's middle.
    pub(super) fn loose(&self, node: Node) -> Inertia {
        if node != Node::Of(Mount::Chassis) {
            return Inertia::default();
        }
        let all = Bill::of(self.assembly, &[], self.neutral).grams;
        let bodies = self.assembly.bodies().iter();
        let drawn: f64 = bodies.map(|body| bill::grams(body, self.assembly)).sum();
        Inertia::point((all - drawn).max(0.0))
    }

    /// The joint of a body with what carries it, which has its name.
    pub(super) fn joint(&mut self, node: Node) {
        let mut of = vec![("name", node.name())];
        let kind = |kind: &str| ("type", kind.to_owned());
        let axis = |axis: &str| ("axis", axis.to_owned());
        match node.moves() {
            Moves::Free => {
                self.element("freejoint", &of);
                return;
            }
            Moves::Turns => of.extend([kind("hinge"), axis("0 0 1")]),
            Moves::Along => of.extend([kind("slide"), axis("1 0 0")]),
            Moves::Upright => of.extend([kind("slide"), axis("0 0 1")]),
        }
        if self.motor_on(node).is_some() {
            // What the motor's own voltage takes from its torque as it turns faster.
            let Motor { rate, stall } = self.scene.motor;
            let damping = stall * MILLI / rate.to_radians();
            of.push(("damping", round(damping).to_string()));
            of.push(("armature", round(damping * SPIN_UP).to_string()));
        }
        match (node, self.scene.pull) {
            (Node::Of(Mount::Link(_)), _) if self.plays() => {
                let play = round(self.scene.play.to_radians());
                of.push(("range", format!("{} {play}", -play)));
                of.extend(limits());
                // Grease: a link that is free in its play does not ring.
                of.push(("damping", "0.00001".to_owned()));
            }
            (Node::Pad(_), _) => {
                let stiffness = self.scene.stiffness / MILLI;
                let quarter = self.assembly.robot().ground().body.mass * MILLI / 4.0;
                let damping = DAMPING * 2.0 * (stiffness * quarter).sqrt();
                of.push(("stiffness", round(stiffness).to_string()));
                of.push(("damping", round(damping).to_string()));
            }
            (Node::Slot(_), Some(Pull { force, rate })) => {
                of.push(("range", format!("0 {}", round(SLOT * MILLI))));
                of.extend(limits());
                of.push(("stiffness", round(rate / MILLI).to_string()));
                of.push(("springref", round(-force / rate * MILLI).to_string()));
                of.push(("damping", "0.1".to_owned()));
            }
            _ => {}
        }
        self.element("joint", &of);
    }

    /// The servo whose motor turns a body.
    pub(super) fn motor_on(&self, node: Node) -> Option<usize> {
        match node {
            Node::Horn(servo) => Some(servo),
            Node::Of(Mount::Link(servo)) if !self.plays() => Some(servo),
            _ => None,
        }
    }
}
