//! Events that a tool observes from outside the robot, and their times.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;

/// A time in cycles of 1/16 us.
pub type Time = i64;

/// A millisecond, in cycles.
pub const MS: Time = 16_000;

/// A time before any event.
pub(crate) const NEVER: Time = Time::MIN / 4;

/// A servo's pulse.
#[derive(Clone, Copy, Debug)]
pub struct Pulse {
    /// The servo's index, 0 to 3.
    pub servo: usize,
    /// The width, cycles.
    pub width: u32,
    /// True if a reset or a power loss cut the pulse short.
    pub is_cut: bool,
    /// True if interrupts were blocked when the pulse should have ended, so the pulse may be too long.
    pub is_end_late: bool,
}

impl Pulse {
    /// Returns a pulse that is neither cut short nor too long.
    pub const fn exact(servo: usize, width: u32) -> Self {
        Self {
            servo,
            width,
            is_cut: false,
            is_end_late: false,
        }
    }
}

/// An event that a tool observes from outside the robot.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// No event other than the passing of time, which may make promises due.
    TimePasses,
    /// The program starts.
    ProgramStart(Cause),
    /// The program is interrupted: RESET is pulled low, or power is lost.
    ProgramCut,
    /// The main loop is stalled until this time.
    MainStalled(Time),
    /// Interrupts are blocked until this time.
    InterruptsBlocked(Time),
    /// The supply changes to this voltage, mV.
    SupplyMv(u32),
    /// A byte arrives at the robot.
    ByteReceived,
    /// The last byte arrives of a line that needs an answer.
    LineReceived {
        /// True if the line is a command, accepted or not. Only a command restarts the `deadman` time.
        is_command: bool,
    },
    /// A command that moves, freezes or rests the robot.
    MotionCommand {
        /// The command's effect on the servos.
        effect: Effect,
        /// True if the robot accepted the command, false if the robot refused it, `None` if the answer is not known.
        is_accepted: Option<bool>,
    },
    /// The calibration of the servos changes or is saved.
    CalibrationChanged {
        /// True if the settings in use are now saved.
        is_saved: bool,
    },
    /// The answer to a line.
    Answer {
        /// The line that was sent.
        line: &'a str,
        /// The line's effect on the servos.
        effect: Effect,
        /// The time at which the line was sent.
        sent_at: Time,
        /// The line that the robot answered.
        answer: &'a str,
    },
    /// The line that was sent at this time got no answer.
    Unanswered(Time, &'a str),
    /// The robot has printed this line, which may be an answer. The line's first byte was written at this time.
    LinePrinted(Time, &'a str),
    /// A pulse begins.
    Pulse(Pulse),
    /// A byte of the EEPROM is written.
    ByteWritten,
    /// A fault that stops the robot occurs.
    Fault,
}
