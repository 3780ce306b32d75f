//! The writer that all formats share: the robot at neutral, as a tree of bodies.

use lizard_kinematics::Solution;

use super::inertia::Inertia;
use super::node::Node;
use super::pieces::Piece;
use super::scene::Scene;
use super::text::{MILLI, XmlWriter, round};
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
    pub xml: XmlWriter,
}

impl<'a> Writer<'a> {
    /// Lists all bodies, each after its parent.
    pub(super) fn nodes(&self) -> Vec<Node> {
        Node::all(self.scene.strut_spring.is_some(), self.has_play())
    }

    /// Body on which a body moves; `None` for the chassis.
    pub(super) fn parent(&self, node: Node) -> Option<Node> {
        node.parent(self.has_play())
    }

    /// Parts whose shapes are in the file.
    pub(super) fn visible_pieces(&self) -> &'a [Piece] {
        match self.scene.has_shapes {
            true => self.pieces,
            false => &[],
        }
    }

    /// True if links have play on their horns.
    pub(super) fn has_play(&self) -> bool {
        self.scene.play > 0.0
    }

    /// Placement of a body on the chassis.
    pub(super) fn placement(&self, node: Node) -> Placement {
        self.assembly.placement(node.frame_mount(), self.neutral)
    }

    /// Position (mm) and rotation (rad) of a body on its parent, or of the chassis on the floor.
    pub(super) fn position_and_yaw(&self, node: Node) -> ([f64; 3], f64) {
        let Some(parent) = self.parent(node) else {
            // At this height, the pad of the longest foot touches the floor.
            let excess_length = self.scene.excess_lengths.into_iter().fold(0.0, f64::max);
            return ([0.0, 0.0, excess_length - self.assembly.stack().floor], 0.0);
        };
        let placement = self.placement(node).relative_to(&self.placement(parent));
        let Placement { origin, x_axis } = placement;
        ([origin.x, origin.y, 0.0], x_axis.angle().to_radians())
    }

    /// Computes mass and inertia of a body.
    pub(super) fn compute_inertia(&self, node: Node) -> Inertia {
        let node_pieces = self.pieces.iter().filter(|piece| piece.node == node);
        let modelled_inertia =
            node_pieces.fold(Inertia::default(), |sum, piece| sum.plus(&piece.inertia));
        match self.parent(node) {
            Some(_) => modelled_inertia.scaled(self.scene.limb_mass_factor),
            None => self
                .correct_chassis(&modelled_inertia)
                .plus(&Inertia::point_mass(self.mass_moved_to_chassis())),
        }
    }

    /// Mass that the scene moves from the limbs to the chassis, g.
    fn mass_moved_to_chassis(&self) -> f64 {
        let limbs = self.pieces.iter();
        let limbs = limbs.filter(|piece| self.parent(piece.node).is_some());
        (1.0 - self.scene.limb_mass_factor) * limbs.map(|piece| piece.inertia.mass).sum::<f64>()
    }

    /// Adjusts the chassis so that the whole robot has the mass and the centre of mass of `[body]`. The mass of items
    /// without a body, such as wires, is added at the plate's middle; a shift of the chassis then corrects the centre
    /// of mass.
    fn correct_chassis(&self, modelled_inertia: &Inertia) -> Inertia {
        let body = self.assembly.robot().ground().body;
        let bill = Bill::compute(self.assembly, &[], self.neutral);
        let bodies = self.assembly.bodies().iter();
        let masses = bodies.map(|body| bill::body_grams(body, self.assembly));
        let parts_mass: f64 = masses.sum();
        // If the mass in `[body]` is less than the parts', the chassis keeps at least half of its modelled mass.
        let unmodelled_mass = (body.mass - parts_mass).max(-modelled_inertia.mass / 2.0);
        let chassis = modelled_inertia.plus(&Inertia::point_mass(unmodelled_mass));
        let [forward_moment, left_moment] = [0, 1]
            .map(|i| body.mass * body.centre_of_mass[i] - bill.grams * bill.centre_of_mass[i]);
        chassis.translated([-left_moment, forward_moment, 0.0].map(|moment| moment / chassis.mass))
    }

    /// Stiffness of a foot's leaf, N/m.
    pub(super) fn leaf_stiffness(&self) -> f64 {
        round(self.scene.leaf_stiffness / MILLI)
    }

    /// Damping of a foot on its leaf, N s/m.
    pub(super) fn leaf_damping(&self) -> f64 {
        let stiffness = self.scene.leaf_stiffness / MILLI;
        let quarter_mass = self.assembly.robot().ground().body.mass * MILLI / 4.0;
        round(LEAF_DAMPING_RATIO * 2.0 * (stiffness * quarter_mass).sqrt())
    }

    /// Centre of a pad's dome in the foot's frame, mm. A full sphere models the dome, since no point above the dome's
    /// rim can touch the floor.
    pub(super) fn dome_centre(&self, servo: usize) -> [f64; 3] {
        let foot = self.assembly.layout().legs[servo].foot;
        let radius = self.assembly.robot().parts().pad.radius;
        let z = self.assembly.stack().floor - self.scene.excess_lengths[servo] + radius;
        [foot.x, foot.y, z]
    }

    /// Servo whose motor turns a body; `None` if no motor does.
    pub(super) fn driving_servo(&self, node: Node) -> Option<usize> {
        match node {
            Node::Horn(servo) => Some(servo),
            Node::OnMount(Mount::Link(servo)) if !self.has_play() => Some(servo),
            _ => None,
        }
    }
}
