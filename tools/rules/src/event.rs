//! Events that are observed from outside the robot, and their times.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;

/// A time in cycles of 1/16 us.
pub type Time = i64;

/// Cycles of a millisecond.
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
    /// True if a reset or the loss of the supply cut the pulse short.
    pub is_cut: bool,
    /// True if interrupts were blocked when the pulse should have ended.
    pub is_held_up: bool,
}

/// An event that is observed from outside the robot.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// Time passes.
    Pass,
    /// The program starts.
    Start(Cause),
    /// RESET is pulled, or power is lost.
    Cut,
    /// The main loop is stalled until this time.
    Stalled(Time),
    /// Interrupts are blocked until this time.
    HeldUp(Time),
    /// The supply has this many mV from now on.
    Supply(u32),
    /// A byte arrives at the robot.
    Byte,
    /// The last byte of a line that needs an answer arrives.
    Line {
        /// True if the line is a command, accepted or not: no other line restarts the time of `deadman`.
        is_command: bool,
    },
    /// A command that moves, freezes or rests the robot; `done` is true if it was accepted,
    /// false if refused, `None` if unknown.
    Order {
        /// The command's effect on the servos.
        effect: Effect,
        /// The outcome of the command.
        done: Option<bool>,
    },
    /// The calibration of the servos changes.
    Calibrated {
        /// True if the settings in use are saved.
        is_saved: bool,
    },
    /// The answer to a line.
    Answer {
        /// The line.
        line: &'a str,
        /// The line's effect on the servos.
        effect: Effect,
        /// The time at which the line was sent.
        asked: Time,
        /// The answer.
        text: &'a str,
    },
    /// The line, sent at this time, was not answered.
    Unanswered(Time, &'a str),
    /// A line that the robot printed, answers included, and the time at which its first byte was written.
    Printed(Time, &'a str),
    /// A pulse begins.
    Pulse(Pulse),
    /// A byte of the EEPROM is written.
    Written,
    /// A fault that stops the robot occurs.
    Fault,
}
