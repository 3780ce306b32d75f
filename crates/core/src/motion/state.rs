//! The state of the motion, and the target that comes next.

use crate::motion::point_to_point::PointToPointMove;
use crate::numbers::gaits::{Gait, GaitId};
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;

/// The robot's activity. The move that leads to an activity counts as that activity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// Walking with a gait, or standing with the gait `stand`.
    Gait(GaitId),
    /// Going to a commanded pose and staying there.
    Pose,
    /// Staying in a pose that was not commanded: after `stop`, after a stop by the guard, or after the last cycle of a
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
    /// A pose, to be held.
    Pose(Pose) = 1,
    /// A gait, reached by a move to its first pose.
    Gait(GaitId),
    /// A standstill in whatever pose the robot has once the gait or move under way has braked; also the end of a gait
    /// that has run for its count of cycles.
    Standstill,
}

/// The state of the motion; a table in `frames.rs` describes its changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// `Resting` is zero, whatever the other variants hold: see `Main::new`.
#[repr(u8)]
pub enum State {
    /// Resting: the servos get no pulses.
    Resting,
    /// Holding the last pose.
    Holding {
        /// True if the pose was commanded, false if the robot was stopped in it.
        is_commanded: bool,
    },
    /// Following a point-to-point move.
    Moving {
        /// The move that is under way.
        path: PointToPointMove,
        /// The current pace of the move; 1024 is full pace.
        pace: u16,
        /// The gait that begins at the end of the move; if `None`, the pose is held.
        gait: Option<GaitId>,
    },
    /// Cycling through a gait.
    Cycling {
        /// The gait's index.
        id: GaitId,
        /// The gait, as loaded from the section.
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
