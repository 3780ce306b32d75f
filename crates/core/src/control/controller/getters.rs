//! The getters of the robot's state, for the console and the main loop.

use super::Controller;
use crate::control::fault::Fault;
use crate::control::safety::Safety;
use crate::memory::copies::SavedState;
use crate::memory::restart::Cause;
use crate::memory::settings::Settings;
use crate::motion::Motion;
use crate::numbers::gaits::Input;
use crate::numbers::section::SectionError;

impl Controller {
    /// The motion: the robot, its pose and its current activity.
    pub const fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The settings in use.
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The error in the robot's section of flash; `None` if the section is valid.
    pub const fn section_error(&self) -> Option<SectionError> {
        self.section_error
    }

    /// The state of the saved settings at power-on.
    pub const fn saved_settings_state(&self) -> SavedState {
        self.saved_settings_state
    }

    /// The input whose contact may end the current step of a routine; [`Input::NONE`] if the step waits for none.
    pub const fn awaited_input(&self) -> Input {
        self.contact.input
    }

    /// The monitor of the supply, the serial port, the pulses and the stack.
    pub const fn safety(&self) -> &Safety {
        &self.safety
    }

    /// The cause of the last reset.
    pub const fn reset_cause(&self) -> Cause {
        self.reset_cause
    }

    /// Resets since power-on, at most 255.
    pub const fn reset_count(&self) -> u8 {
        self.reset_count
    }

    /// The current fault: [`Fault::Guard`] while the guard holds the robot, otherwise the fault that [`Safety`]
    /// recorded.
    pub fn fault(&self) -> Option<Fault> {
        match self.motion.hazard() {
            Some(_) => Some(Fault::Guard),
            None => self.safety.fault(),
        }
    }

    /// Consecutive resets, including the last one, that a weak supply may have caused.
    pub const fn suspected_brown_outs(&self) -> u8 {
        self.suspected_brown_outs
    }
}
