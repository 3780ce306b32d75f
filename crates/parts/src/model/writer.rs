//! The writer that all formats share: the robot at neutral, as a tree of bodies.

use lizard_kinematics::Solution;

use super::inertia::Inertia;
use super::node::Node;
use super::pieces::Piece;
use super::scene::Scene;
use super::text::{MILLI, Xml, round};
use crate::bill::{self, Bill};
use crate::bodies::assembly::Assembly;
use crate::layers::body::Mount;
use crate::layers::placement::Placement;

/// Damping ratio of a foot on its leaf while it carries a quarter of the robot's mass.
const LEAF_DAMPING_RATIO: f64 = 0.4;

/// A writer of a robot and its scene.
pub(super) struct Writer<'a> {
    pub assembly: &'a Assembly,
    pub neutral: &'a Solution,
    pub scene: &'a Scene,
    pub pieces: &'a [Piece],
    pub xml: Xml,
}

impl<'a> Writer<'a> {
    /// All bodies, each after its parent.
    pub(super) fn nodes(&self) -> Vec<Node> {
        Node::all(self.scene.strut_spring.is_some(), self.has_play())
    }

    /// The body on which another one moves; `None` for the chassis.
    pub(super) fn parent(&self, node: Node) -> Option<Node> {
        node.parent(self.has_play())
    }

    /// The parts whose shapes go into the file.
    pub(super) fn visible_pieces(&self) -> &'a [Piece] {
        match self.scene.has_shapes {
            true => self.pieces,
            false => &[],
        }
    }

    /// True if the links have play on their horns.
    pub(super) fn has_play(&self) -> bool {
        self.scene.play > 0.0
    }

    /// The place of a body on the chassis.
    pub(super) fn place(&self, node: Node) -> Placement {
        self.assembly.place(node.frame_mount(), self.neutral)
    }

    /// The place of a body on its parent.
    pub(super) fn place_on_parent(&self, node: Node) -> Placement {
        match self.parent(node) {
            Some(parent) => self.place(node).relative_to(&self.place(parent)),
            None => Placement::CHASSIS,
        }
    }

    /// Height of the chassis frame, mm, at which the pad of the longest foot touches the floor.
    pub(super) fn chassis_height(&self) -> f64 {
        self.scene.excess_lengths.into_iter().fold(0.0, f64::max) - self.assembly.stack().floor
    }

    /// The mass and the inertia of a body.
    pub(super) fn inertia(&self, node: Node) -> Inertia {
        let node_pieces = self.pieces.iter().filter(|piece| piece.node == node);
        let drawn_inertia =
            node_pieces.fold(Inertia::default(), |sum, piece| sum.plus(&piece.inertia));
        match self.parent(node) {
            Some(_) => drawn_inertia.scaled(self.scene.limb_mass_factor),
            None => self
                .corrected_chassis(&drawn_inertia)
                .plus(&Inertia::point_mass(self.mass_moved_to_chassis())),
        }
    }

    /// The mass that the scene takes from the limbs and adds to the chassis, g.
    fn mass_moved_to_chassis(&self) -> f64 {
        let limbs = self.pieces.iter();
        let limbs = limbs.filter(|piece| self.parent(piece.node).is_some());
        (1.0 - self.scene.limb_mass_factor) * limbs.map(|piece| piece.inertia.mass).sum::<f64>()
    }

    /// The chassis, adjusted so that the whole robot has the mass and the mass centre of `[body]`. The mass of the
    /// parts that are not drawn, such as wires, is put at the plate's middle; then the chassis is shifted to correct
    /// the mass centre.
    fn corrected_chassis(&self, drawn_inertia: &Inertia) -> Inertia {
        let body = self.assembly.robot().ground().body;
        let bill = Bill::of(self.assembly, &[], self.neutral);
        let bodies = self.assembly.bodies().iter();
        let parts_mass: f64 = bodies
            .map(|body| bill::body_grams(body, self.assembly))
            .sum();
        // If `[body]` states less mass than the parts have, the chassis keeps at least half of its drawn mass.
        let undrawn_mass = (body.mass - parts_mass).max(-drawn_inertia.mass / 2.0);
        let chassis = drawn_inertia.plus(&Inertia::point_mass(undrawn_mass));
        let [moment_ahead, moment_left] =
            [0, 1].map(|i| body.mass * body.mass_centre[i] - bill.grams * bill.centre[i]);
        chassis.translated([-moment_left, moment_ahead, 0.0].map(|moment| moment / chassis.mass))
    }

    /// Stiffness of a foot's leaf, N/m, and its damping, N s/m.
    pub(super) fn leaf_spring(&self) -> [f64; 2] {
        let stiffness = self.scene.leaf_stiffness / MILLI;
        let quarter_mass = self.assembly.robot().ground().body.mass * MILLI / 4.0;
        let damping = LEAF_DAMPING_RATIO * 2.0 * (stiffness * quarter_mass).sqrt();
        [stiffness, damping].map(round)
    }

    /// The centre of a pad's dome in the frame of its foot, mm. A full sphere models the dome, since nothing
    /// above its rim can touch the floor.
    pub(super) fn pad_middle(&self, servo: usize) -> [f64; 3] {
        let foot = self.assembly.layout().legs[servo].foot;
        let radius = self.assembly.robot().parts().pad.radius;
        let z = self.assembly.stack().floor - self.scene.excess_lengths[servo] + radius;
        [foot.x, foot.y, z]
    }

    /// The servo whose motor turns a body, if any.
    pub(super) fn driving_servo(&self, node: Node) -> Option<usize> {
        match node {
            Node::Horn(servo) => Some(servo),
            Node::OnMount(Mount::Link(servo)) if !self.has_play() => Some(servo),
            _ => None,
        }
    }
}
