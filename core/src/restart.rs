//! Why the program began.
//!
//! A robot that begins again in mid-step does not have to fall over: the servos
//! are where they were, and a word of memory that survives a reset can say where
//! that is.

use crate::pose::Pose;
use crate::text::Text;

/// What made the program begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Cause {
    /// Power came on.
    #[default]
    Power,
    /// The reset button, or a computer that opened the port.
    External,
    /// The supply of the chip was too low for a moment.
    BrownOut,
    /// The watchdog: the program, its clock or its pulses hung.
    Watchdog,
}

/// What is known at the beginning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Restart {
    /// Why.
    pub cause: Cause,
    /// How many times since power came on; stays at 255.
    pub count: u8,
    /// Where the servos were held until then, if that is known.
    pub pose: Option<Pose>,
}

impl Cause {
    /// Its word in `status`.
    pub const fn word(self) -> Text {
        match self {
            Self::Power => Text::CausePower,
            Self::External => Text::CauseExternal,
            Self::BrownOut => Text::CauseBrownOut,
            Self::Watchdog => Text::CauseWatchdog,
        }
    }
}
