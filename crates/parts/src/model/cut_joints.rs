//! Joints at which the robot's closed loops are cut to obtain a tree of bodies. Constraints close the loops again.

use lizard_kinematics::{End, Side};
use lizard_robot::servo::LEG_NAMES;

use crate::layers::body::Mount;
use crate::model::node::Node;
use crate::model::writer::Writer;

/// A cut joint: a common point of two bodies at which a constraint closes a loop.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CutJoint {
    /// Name, such as `end head`.
    pub name: String,
    /// The two bodies.
    pub bodies: [Node; 2],
    /// Position of the common point on the x axis of the first body's frame, mm.
    pub x: f64,
}

impl CutJoint {
    /// Name of the joint without spaces.
    pub(super) fn identifier(&self) -> String {
        self.name.replace(' ', "_")
    }
}

impl Writer<'_> {
    /// Lists the cut joints of head and tail, of the sliders, of the legs' parallelograms and of the struts.
    pub(super) fn list_cut_joints(&self) -> Vec<CutJoint> {
        let lizard = self.assembly.robot().lizard();
        let mut joints = Vec::new();
        let mut add_joint = |name, bodies, x| joints.push(CutJoint { name, bodies, x });
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
        for (servo, leg) in LEG_NAMES.into_iter().enumerate() {
            let bodies = [Mount::Foot(servo), Mount::Follower(servo)].map(Node::OnMount);
            add_joint(format!("follower joint {leg}"), bodies, lizard.leg.coupler);
            let strut = match self.scene.strut_spring {
                Some(_) => Node::SlotPin(servo),
                None => Node::OnMount(Mount::Strut(servo)),
            };
            let bodies = [strut, Node::OnMount(Mount::Crank(servo))];
            let length = self.assembly.layout().legs[servo].strut_length;
            add_joint(format!("leg anchor {leg}"), bodies, length);
        }
        joints
    }
}
