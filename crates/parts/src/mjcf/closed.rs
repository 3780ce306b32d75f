//! The joints at which the robot's loops are cut; constraints close them again.

use lizard_kinematics::{End, Side, Vector};

use crate::bodies::assembly::Assembly;
use crate::layers::body::Mount;
use crate::mjcf::node::Node;

/// A joint that a constraint closes: a point that two bodies share.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Closed {
    /// Its name, such as `end head`.
    pub name: String,
    /// The two bodies.
    pub bodies: [Node; 2],
    /// The point in the first body's frame, mm.
    pub at: Vector,
}

/// All such joints: of head and tail, sliders, the legs' parallelograms, struts.
pub(crate) fn all(assembly: &Assembly, slotted: bool) -> Vec<Closed> {
    let (robot, layout) = (assembly.robot(), assembly.layout());
    let mut all = Vec::new();
    let mut close = |name: String, bodies: [Node; 2], at: Vector| {
        all.push(Closed { name, bodies, at });
    };
    for end in End::ALL {
        let [left, right] = end.servos();
        close(
            format!("end {}", end.name()),
            [left, right].map(|servo| Node::Of(Mount::Coupler(servo))),
            Vector::new(robot.lizard().end(end).coupler_left, 0.0),
        );
    }
    for side in Side::ALL {
        let [front, _] = side.servos();
        close(
            format!("slider {}", side.name()),
            [Mount::Rod(side), Mount::Link(front)].map(Node::Of),
            Vector::default(),
        );
    }
    for servo in 0..4 {
        let leg = lizard_robot::servo::LEGS[servo];
        close(
            format!("follower joint {leg}"),
            [Mount::Foot(servo), Mount::Follower(servo)].map(Node::Of),
            Vector::new(robot.lizard().leg.coupler, 0.0),
        );
        let strut = match slotted {
            true => Node::Slot(servo),
            false => Node::Of(Mount::Strut(servo)),
        };
        close(
            format!("leg anchor {leg}"),
            [strut, Node::Of(Mount::Crank(servo))],
            Vector::new(layout.legs[servo].strut_length, 0.0),
        );
    }
    all
}
