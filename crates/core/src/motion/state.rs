//! The state of the motion, and its targets.

use crate::motion::point_to_point::PointToPointMove;
use crate::numbers::gaits::{Gait, GaitId};
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;

/// The robot's activity. The move that leads to an activity counts as that activity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// Walking with a gait, or standing with the gait `stand`.
    Gait(GaitId),
    /// Moving to a commanded pose, or holding it.
    Pose,
    /// Holding a pose that was not commanded: after `stop`, after a stop by the guard, or after the last cycle of a
    /// counted gait.
    Stop,
    /// Resting without pulses: the servos are limp.
    Rest,
}

/// The target of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Discriminants start at 1, so that `Option::None` is all zeros: see `Main::new`.
#[repr(u8)]
pub enum Target {
    /// A pose, which is then held.
    Pose(Pose) = 1,
    /// A gait, reached by a move to its first pose.
    Gait(GaitId),
    /// A standstill in the pose that the robot has after braking the current gait or move; also the end of a counted
    /// gait.
    Standstill,
}

/// The state of the motion; the table in `frames.rs` describes its changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// `Resting` is all zeros: see `Main::new`.
#[repr(u8)]
pub enum State {
    /// Resting: the servos get no pulses.
    Resting,
    /// Holding the last pose.
    Holding {
        /// True if the pose was commanded, false if the robot was stopped in this pose.
        is_commanded: bool,
    },
    /// Following a point-to-point move.
    Moving {
        /// The current move.
        path: PointToPointMove,
        /// The current pace of the move; 1024 is full pace.
        pace: u16,
        /// The gait that starts at the end of the move; `None` if the pose is then held.
        gait: Option<GaitId>,
    },
    /// Cycling through a gait.
    Cycling {
        /// The gait's index.
        id: GaitId,
        /// The gait, loaded from the section.
        gait: Gait,
        /// The phase, 1/2^24 cycle.
        phase: u32,
        /// The current pace of the gait; 1024 is full pace.
        pace: u16,
    },
}

impl State {
    /// Returns the state at the beginning of a gait: phase 0, pace 0.
    pub fn cycling(robot: &Robot, id: GaitId) -> Self {
        Self::Cycling {
            id,
            gait: robot.gait(id),
            phase: 0,
            pace: 0,
        }
    }
}
