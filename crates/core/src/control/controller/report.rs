//! The state of the robot, as a console reads it.

use super::Control;
use crate::control::fault::Fault;
use crate::control::safety::Safety;
use crate::memory::copies::SavedState;
use crate::memory::restart::Cause;
use crate::memory::settings::Settings;
use crate::motion::Motion;
use crate::numbers::gaits::Input;
use crate::numbers::section::Damage;

impl Control {
    /// The robot's motion.
    pub const fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The settings in use.
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The reason why the flash holds no usable robot; `None` if it holds one.
    pub const fn damage(&self) -> Option<Damage> {
        self.damage
    }

    /// The state of the saved settings at power-on.
    pub const fn saved_settings(&self) -> SavedState {
        self.saved_settings
    }

    /// The input that the last step of a routine waited for.
    pub const fn input(&self) -> Input {
        self.contact.input
    }

    /// The watch over supply, line, pulses and stack.
    pub const fn safety(&self) -> &Safety {
        &self.safety
    }

    /// The cause of the last reset.
    pub const fn cause(&self) -> Cause {
        self.cause
    }

    /// Resets since power-on; stays at 255.
    pub const fn resets(&self) -> u8 {
        self.restarts
    }

    /// The present fault: [`Fault::Guard`] while the guard holds the robot, otherwise the fault of [`Safety`].
    pub fn fault(&self) -> Option<Fault> {
        match self.motion.hazard() {
            Some(_) => Some(Fault::Guard),
            None => self.safety.fault(),
        }
    }

    /// Consecutive resets that a weak supply may have caused.
    pub const fn brown_outs(&self) -> u8 {
        self.brown_outs
    }
}
