//! Joints of the models: names without spaces, ranges, motors, springs, friction.

use lizard_robot::SLOT_LENGTH;
use lizard_robot::servo::SERVO_NAMES;

use crate::layers::body::Mount;
use crate::model::node::Node;
use crate::model::scene::StrutSpring;
use crate::model::text::{MILLI, round};
use crate::model::writer::Writer;

/// Smallest spring rate in a model, N/mm: at a rate of 0, the relaxed position would be infinitely far away.
const MIN_SPRING_RATE: f64 = 1e-3;

impl Node {
    /// Name of the node without spaces, as ROS requires.
    pub(super) fn identifier(self) -> String {
        self.name().replace(' ', "_")
    }
}

impl Writer<'_> {
    /// Name of the joint between a body and its parent: the driving servo's name, or a name derived from the body's. In
    /// SDF no joint may have the name of a body.
    pub(super) fn joint_name(&self, node: Node) -> String {
        match self.driving_servo(node) {
            Some(servo) => SERVO_NAMES[servo].to_owned(),
            None => format!("{}_joint", node.identifier()),
        }
    }

    /// Computes the range of a body's joint, rad or m from neutral; `None` for an unlimited joint.
    pub(super) fn joint_range(&self, node: Node) -> Option<[f64; 2]> {
        let robot = self.assembly.robot();
        let range = match (self.driving_servo(node), node) {
            (Some(servo), _) => {
                let (min, max) = robot.servos()[servo].travel();
                [min, max].map(f64::to_radians)
            }
            (None, Node::OnMount(Mount::Link(_))) => {
                let play = self.scene.play.to_radians();
                [-play, play]
            }
            (None, Node::OnMount(Mount::Rod(side))) => {
                let (limits, neutral_stroke) = (robot.limits(), self.neutral.side(side).s);
                [limits.stroke_min, limits.stroke_max].map(|limit| (limit - neutral_stroke) * MILLI)
            }
            (None, Node::SlotPin(_)) => [0.0, SLOT_LENGTH * MILLI],
            _ => return None,
        };
        Some(range.map(round))
    }

    /// Largest torque (N m) and largest speed (rad/s) of the motor that drives a body's joint; `None` if no motor does.
    pub(super) fn effort_and_velocity(&self, node: Node) -> Option<[f64; 2]> {
        let motor = &self.scene.motors.per_servo[self.driving_servo(node)?];
        Some([motor.stall_torque * MILLI, motor.no_load_speed.to_radians()].map(round))
    }

    /// Relaxed position (m) and stiffness (N/m) of the spring in a body's joint; `None` if the joint has no spring.
    pub(super) fn spring_values(&self, node: Node) -> Option<[f64; 2]> {
        match (node, self.scene.strut_spring) {
            (Node::Pad(_), _) => Some([0.0, self.leaf_stiffness()]),
            (Node::SlotPin(_), Some(StrutSpring { preload, rate })) => {
                let rate = rate.max(MIN_SPRING_RATE);
                Some([-preload / rate * MILLI, rate / MILLI].map(round))
            }
            _ => None,
        }
    }

    /// Damping (N m s or N s/m) and dry friction (N m or N) of a body's joint.
    pub(super) fn damping_and_friction(&self, node: Node) -> [f64; 2] {
        let motors = &self.scene.motors;
        let friction = motors.joint_friction;
        let values = match (self.driving_servo(node), node) {
            (Some(servo), _) => {
                [motors.per_servo[servo].damping(), friction.pin_torque].map(|value| value * MILLI)
            }
            (None, Node::OnMount(Mount::Rod(_))) => [0.0, friction.slider_force],
            (None, Node::Pad(_)) => [self.leaf_damping(), 0.0],
            // Grease damps a link that moves freely within its play.
            (None, Node::OnMount(Mount::Link(_))) => [1e-5, self.scene.pin_friction * MILLI],
            (None, Node::SlotPin(_)) => [0.1, 0.0],
            _ => [0.0, self.scene.pin_friction * MILLI],
        };
        values.map(round)
    }
}
