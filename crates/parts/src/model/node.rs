//! Rigid bodies of the model: the parent of each, and its motion on the parent.
//!
//! The bodies form a tree: each closed loop of the robot is cut at one of its joints (`closed.rs`).

use lizard_kinematics::Side;
use lizard_robot::servo::{LEGS, NAMES};

use crate::layers::body::Mount;

/// A rigid body of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Node {
    /// All bodies on one of the assembly's mounts.
    OnMount(Mount),
    /// The horn of a servo that has play between horn and link.
    Horn(usize),
    /// The post of a foot with its pad, which moves up and down on the leaf.
    Pad(usize),
    /// The pin in the slot of a strut, and the spring that pulls at it.
    Slot(usize),
}

/// The degree of freedom of a body on its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Freedom {
    /// Free in space.
    Free,
    /// Turning about a vertical axis through its origin.
    Turns,
    /// Sliding along its own x axis.
    SlidesAlongX,
    /// Sliding up and down.
    SlidesVertically,
}

impl Node {
    /// Every body of the robot, each after its parent.
    pub fn all(slotted: bool, play: bool) -> Vec<Self> {
        let mut all = vec![Self::OnMount(Mount::Chassis)];
        for servo in 0..4 {
            if play {
                all.push(Self::Horn(servo));
            }
            let mounts = [
                Mount::Link,
                Mount::Coupler,
                Mount::Crank,
                Mount::Follower,
                Mount::Foot,
                Mount::Strut,
            ];
            all.extend(mounts.map(|mount| Self::OnMount(mount(servo))));
            all.push(Self::Pad(servo));
            if slotted {
                all.push(Self::Slot(servo));
            }
        }
        for side in Side::ALL {
            all.extend([Mount::Sleeve(side), Mount::Rod(side)].map(Self::OnMount));
        }
        all
    }

    /// The node's parent; `None` for the chassis.
    pub fn parent(self, play: bool) -> Option<Self> {
        let chassis = Self::OnMount(Mount::Chassis);
        Some(match self {
            Self::OnMount(Mount::Chassis) => return None,
            Self::OnMount(Mount::Link(servo)) if play => Self::Horn(servo),
            Self::Horn(_)
            | Self::OnMount(Mount::Link(_) | Mount::Crank(_) | Mount::Follower(_)) => chassis,
            Self::OnMount(Mount::Foot(servo)) => Self::OnMount(Mount::Crank(servo)),
            Self::OnMount(Mount::Strut(servo) | Mount::Coupler(servo)) => {
                Self::OnMount(Mount::Link(servo))
            }
            Self::OnMount(Mount::Sleeve(side)) => Self::OnMount(Mount::Link(side.servos()[1])),
            Self::OnMount(Mount::Rod(side)) => Self::OnMount(Mount::Sleeve(side)),
            Self::Pad(servo) => Self::OnMount(Mount::Foot(servo)),
            Self::Slot(servo) => Self::OnMount(Mount::Strut(servo)),
        })
    }

    /// The node's motion on its parent.
    pub fn freedom(self) -> Freedom {
        match self {
            Self::OnMount(Mount::Chassis) => Freedom::Free,
            Self::OnMount(Mount::Rod(_)) | Self::Slot(_) => Freedom::SlidesAlongX,
            Self::Pad(_) => Freedom::SlidesVertically,
            _ => Freedom::Turns,
        }
    }

    /// The mount whose frame the node uses.
    pub fn frame(self) -> Mount {
        match self {
            Self::OnMount(mount) => mount,
            Self::Horn(servo) => Mount::Link(servo),
            Self::Pad(servo) => Mount::Foot(servo),
            Self::Slot(servo) => Mount::Strut(servo),
        }
    }

    /// The node's name, which is also the name of its joint to the parent.
    pub fn name(self) -> String {
        let of = |what: &str, name: &str| format!("{what} {name}");
        match self {
            Self::OnMount(Mount::Chassis) => "chassis".to_owned(),
            Self::OnMount(Mount::Link(servo)) => of("link", NAMES[servo]),
            Self::OnMount(Mount::Coupler(servo)) => of("coupler", NAMES[servo]),
            Self::OnMount(Mount::Crank(servo)) => of("crank", LEGS[servo]),
            Self::OnMount(Mount::Follower(servo)) => of("follower", LEGS[servo]),
            Self::OnMount(Mount::Foot(servo)) => of("leg coupler", LEGS[servo]),
            Self::OnMount(Mount::Strut(servo)) => of("strut", LEGS[servo]),
            Self::OnMount(Mount::Sleeve(side)) => of("sleeve", side.name()),
            Self::OnMount(Mount::Rod(side)) => of("rod", side.name()),
            Self::Horn(servo) => of("horn", NAMES[servo]),
            Self::Pad(servo) => of("foot", LEGS[servo]),
            Self::Slot(servo) => of("slot", LEGS[servo]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_body_comes_once_and_after_its_parent() {
        for (slotted, play) in [(false, false), (true, false), (false, true), (true, true)] {
            let all = Node::all(slotted, play);
            for (index, node) in all.iter().enumerate() {
                assert!(!all[..index].contains(node), "{node:?}");
                match node.parent(play) {
                    Some(parent) => assert!(all[..index].contains(&parent), "{node:?}"),
                    None => assert_eq!(*node, Node::OnMount(Mount::Chassis)),
                }
            }
        }
    }
}
