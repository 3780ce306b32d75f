//! What the servos follow, and what comes after it.

use crate::motion::point_to_point::PointToPoint;
use crate::numbers::gaits::{Gait, GaitId};
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;

/// What the robot does, or is on its way to do.
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

/// Where a motion leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// From 1 on, since none at all has to be zero: see `Main::new`.
#[repr(u8)]
pub enum Target {
    /// To a pose, to be held.
    Pose(Pose) = 1,
    /// To the first pose of a gait, and through its cycles.
    Gait(GaitId),
}

/// What the servos follow at the moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// `Resting` is zero, whatever the others hold: see `Main::new`.
#[repr(u8)]
pub enum State {
    /// Nothing: there are no pulses.
    Resting,
    /// The last pose.
    Holding {
        /// Whether it was asked for, or the robot was stopped in it.
        asked: bool,
    },
    /// A point-to-point move.
    Moving {
        path: PointToPoint,
        pace: u16,
        /// The gait that begins at its end; without one, the pose is held.
        gait: Option<GaitId>,
    },
    /// A gait.
    Cycling {
        id: GaitId,
        gait: Gait,
        /// 1/2^24 cycle.
        phase: u32,
        pace: u16,
    },
}

impl State {
    /// A gait from phase 0, still without pace.
    pub fn cycling(robot: &Robot, id: GaitId) -> Self {
        Self::Cycling {
            id,
            gait: robot.gait(id),
            phase: 0,
            pace: 0,
        }
    }
}
