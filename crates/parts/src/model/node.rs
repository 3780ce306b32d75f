//! Rigid bodies of the model, each with its parent and its freedom on the parent.
//!
//! The bodies form a tree: each closed loop of the robot is cut at one of its joints (`cut_joints.rs`).

use lizard_kinematics::Side;
use lizard_robot::servo::{LEG_NAMES, SERVO_NAMES};

use crate::layers::body::Mount;

/// A rigid body of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Node {
    /// All parts on one of the assembly's mounts.
    OnMount(Mount),
    /// The horn of a servo with play between horn and link.
    Horn(usize),
    /// The post of a foot with its pad, which moves up and down on the leaf.
    Pad(usize),
    /// The pin in a strut's slot, and the spring that pulls at the pin.
    SlotPin(usize),
}

/// The degree of freedom of a body on its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Freedom {
    /// Free in space.
    Free,
    /// Turning about the vertical axis through its origin.
    TurnsAboutZ,
    /// Sliding along its own x axis.
    SlidesAlongX,
    /// Sliding up and down.
    SlidesVertically,
}

impl Node {
    /// Lists all bodies of the robot, each after its parent.
    pub fn all(has_slotted_struts: bool, has_play: bool) -> Vec<Self> {
        let mut nodes = vec![Self::OnMount(Mount::Chassis)];
        for servo in 0..4 {
            if has_play {
                nodes.push(Self::Horn(servo));
            }
            let mounts = [
                Mount::Link,
                Mount::Coupler,
                Mount::Crank,
                Mount::Follower,
                Mount::Foot,
                Mount::Strut,
            ];
            nodes.extend(mounts.map(|mount| Self::OnMount(mount(servo))));
            nodes.push(Self::Pad(servo));
            if has_slotted_struts {
                nodes.push(Self::SlotPin(servo));
            }
        }
        for side in Side::ALL {
            nodes.extend([Mount::Sleeve(side), Mount::Rod(side)].map(Self::OnMount));
        }
        nodes
    }

    /// Parent of the node; `None` for the chassis.
    pub fn parent(self, has_play: bool) -> Option<Self> {
        let mount = match self {
            Self::OnMount(Mount::Chassis) => return None,
            Self::OnMount(Mount::Link(servo)) if has_play => return Some(Self::Horn(servo)),
            Self::Horn(_) => Mount::Chassis,
            Self::OnMount(Mount::Link(_) | Mount::Crank(_) | Mount::Follower(_)) => Mount::Chassis,
            Self::OnMount(Mount::Foot(servo)) => Mount::Crank(servo),
            Self::OnMount(Mount::Strut(servo) | Mount::Coupler(servo)) => Mount::Link(servo),
            Self::OnMount(Mount::Sleeve(side)) => Mount::Link(side.servos()[1]),
            Self::OnMount(Mount::Rod(side)) => Mount::Sleeve(side),
            Self::Pad(_) | Self::SlotPin(_) => self.frame_mount(),
        };
        Some(Self::OnMount(mount))
    }

    /// Freedom of the node on its parent.
    pub fn freedom(self) -> Freedom {
        match self {
            Self::OnMount(Mount::Chassis) => Freedom::Free,
            Self::OnMount(Mount::Rod(_)) | Self::SlotPin(_) => Freedom::SlidesAlongX,
            Self::Pad(_) => Freedom::SlidesVertically,
            _ => Freedom::TurnsAboutZ,
        }
    }

    /// Mount whose frame is the node's frame.
    pub fn frame_mount(self) -> Mount {
        match self {
            Self::OnMount(mount) => mount,
            Self::Horn(servo) => Mount::Link(servo),
            Self::Pad(servo) => Mount::Foot(servo),
            Self::SlotPin(servo) => Mount::Strut(servo),
        }
    }

    /// Name of the node; in MJCF also the name of its joint to the parent.
    pub fn name(self) -> String {
        match self {
            Self::OnMount(mount) => mount.name(),
            Self::Horn(servo) => format!("horn {}", SERVO_NAMES[servo]),
            Self::Pad(servo) => format!("foot {}", LEG_NAMES[servo]),
            Self::SlotPin(servo) => format!("slot {}", LEG_NAMES[servo]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_body_is_listed_once_and_after_its_parent() {
        for (has_slotted_struts, has_play) in
            [(false, false), (true, false), (false, true), (true, true)]
        {
            let nodes = Node::all(has_slotted_struts, has_play);
            for (index, node) in nodes.iter().enumerate() {
                assert!(!nodes[..index].contains(node), "{node:?}");
                match node.parent(has_play) {
                    Some(parent) => assert!(nodes[..index].contains(&parent), "{node:?}"),
                    None => assert_eq!(*node, Node::OnMount(Mount::Chassis)),
                }
            }
        }
    }
}
