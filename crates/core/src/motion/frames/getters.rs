//! The getters with which other modules read the state of a motion.

use super::Motion;
use crate::guard::hazard::Hazard;
use crate::motion::state::State;
use crate::numbers::pose::{Pose, Pulses};

impl Motion {
    /// The phase of the gait, 1/2^24 cycle; 0 if no gait is running.
    pub const fn phase(&self) -> u32 {
        match self.state {
            State::Cycling { phase, .. } => phase,
            _ => 0,
        }
    }

    /// The pose of the last frame.
    pub const fn pose(&self) -> &Pose {
        &self.servo_state.pose
    }

    /// True while the servos get no pulses.
    pub const fn is_resting(&self) -> bool {
        matches!(self.state, State::Resting)
    }

    /// The pulses of the last frame, including servos that are not awake yet.
    pub const fn sent_pulses(&self) -> &Pulses {
        &self.servo_state.sent_pulses
    }

    /// The pace of gaits that was set, in percent of the pace in robot.toml.
    pub const fn speed_percent(&self) -> u8 {
        self.speed_percent
    }

    /// Frames since the program started.
    pub const fn frame_count(&self) -> u32 {
        self.frame_count
    }

    /// The hazard that made the guard stop the robot; `None` if the guard has not stopped the robot, or once
    /// another motion has been ordered.
    pub const fn hazard(&self) -> Option<Hazard> {
        self.hazard
    }
}
