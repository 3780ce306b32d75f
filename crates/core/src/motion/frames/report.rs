//! The state of a motion, as other modules read it.

use super::Motion;
use crate::guard::hazard::Hazard;
use crate::motion::state::State;
use crate::numbers::pose::{Pose, Pulses};

impl Motion {
    /// Phase of the gait, 1/2^24 cycle; 0 if no gait runs.
    pub const fn phase(&self) -> u32 {
        match self.state {
            State::Cycling { phase, .. } => phase,
            _ => 0,
        }
    }

    /// The pose of the last frame.
    pub const fn pose(&self) -> &Pose {
        &self.stance.pose
    }

    /// True while the servos get no pulses.
    pub const fn is_resting(&self) -> bool {
        matches!(self.state, State::Resting)
    }

    /// The pulses of the last frame, including those of servos that sleep.
    pub const fn sent(&self) -> &Pulses {
        &self.stance.sent
    }

    /// Speed of gaits in percent.
    pub const fn speed(&self) -> u8 {
        self.speed
    }

    /// Frames since power-on.
    pub const fn frames(&self) -> u32 {
        self.frames
    }

    /// The reason why the guard stopped the robot; `None` if it has not, or once the next motion has begun.
    pub const fn hazard(&self) -> Option<Hazard> {
        self.hazard
    }
}
