//! The state of the motion, and the target that comes next.

use crate::motion::point_to_point::PointToPoint;
use crate::numbers::gaits::{Gait, GaitId};
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;

/// The robot's activity. During the move that leads to an activity, it already has that activity's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// A gait (`stand` is one).
    Gait(GaitId),
    /// Going to a pose and staying there.
    Pose,
    /// Staying where it was stopped, by `stop` or by the guard.
    Stop,
    /// No pulses: the servos are limp.
    Rest,
}

/// The target of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Starts at 1, since `None` has to be zero: see `Main::new`.
#[repr(u8)]
pub enum Target {
    /// A pose, to be held.
    Pose(Pose) = 1,
    /// A gait, reached by a move to its first pose.
    Gait(GaitId),
    /// The stop of a gait or a move, in whatever pose the robot has after braking; also the end of a gait that has
    /// run for the requested number of cycles.
    End,
}

/// The path that the servos follow in this frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// `Resting` is zero, whatever the other variants hold: see `Main::new`.
#[repr(u8)]
pub enum State {
    /// Resting: the servos get no pulses.
    Resting,
    /// Holding the last pose.
    Holding {
        /// True if a command ordered the pose, false if the robot was stopped in it.
        is_ordered: bool,
    },
    /// Following a point-to-point move.
    Moving {
        path: PointToPoint,
        pace: u16,
        /// The gait that begins at the end of the move; if `None`, the pose is held.
        gait: Option<GaitId>,
    },
    /// Cycling through a gait.
    Cycling {
        id: GaitId,
        gait: Gait,
        /// The phase, 1/2^24 cycle.
        phase: u32,
        pace: u16,
    },
}

impl State {
    /// A gait at phase 0 and pace 0.
    pub fn cycling(robot: &Robot, id: GaitId) -> Self {
        Self::Cycling {
            id,
            gait: robot.gait(id),
            phase: 0,
            pace: 0,
        }
    }
}
