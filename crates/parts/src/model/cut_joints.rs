//! Joints at which the robot's closed loops are cut to obtain a tree of bodies. Constraints close the loops again.

use lizard_kinematics::{End, Side, Vector};

use crate::bodies::assembly::Assembly;
use crate::layers::body::Mount;
use crate::model::node::Node;

/// A cut joint: a common point of two bodies at which a constraint closes a loop.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CutJoint {
    /// Name, such as `end head`.
    pub name: String,
    /// The two bodies.
    pub bodies: [Node; 2],
    /// The common point, frame of the first body, mm.
    pub point: Vector,
}

/// Lists the cut joints of head and tail, of the sliders, of the legs' parallelograms and of the struts.
pub(crate) fn list_cut_joints(assembly: &Assembly, has_slotted_struts: bool) -> Vec<CutJoint> {
    let (lizard, layout) = (assembly.robot().lizard(), assembly.layout());
    let mut joints = Vec::new();
    // Each point is on the x axis of the first body.
    let mut add_joint = |name: String, bodies: [Node; 2], x: f64| {
        let point = Vector::new(x, 0.0);
        joints.push(CutJoint {
            name,
            bodies,
            point,
        });
    };
    for end in End::ALL {
        let bodies = end.servos().map(Mount::Coupler).map(Node::OnMount);
        let length = lizard.end(end).left_coupler_length;
        add_joint(format!("end {end}"), bodies, length);
    }
    for side in Side::ALL {
        let [front, _] = side.servos();
        let bodies = [Mount::Rod(side), Mount::Link(front)].map(Node::OnMount);
        add_joint(format!("slider {side}"), bodies, 0.0);
    }
    for servo in 0..4 {
        let leg = lizard_robot::servo::LEG_NAMES[servo];
        let bodies = [Mount::Foot(servo), Mount::Follower(servo)].map(Node::OnMount);
        add_joint(format!("follower joint {leg}"), bodies, lizard.leg.coupler);
        let strut = match has_slotted_struts {
            true => Node::SlotPin(servo),
            false => Node::OnMount(Mount::Strut(servo)),
        };
        let bodies = [strut, Node::OnMount(Mount::Crank(servo))];
        let length = layout.legs[servo].strut_length;
        add_joint(format!("leg anchor {leg}"), bodies, length);
    }
    joints
}
