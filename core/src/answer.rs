//! Answers: what the robot replies to a line.
//!
//! Every line gets exactly one final line, `ok ...` or `err <code> <reason>`; some
//! answers have other lines before it.

use crate::gait::GaitId;
use crate::refusal::Refusal;

/// The next line of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Answer {
    /// `ok` and the line as it was understood.
    Done = 1,
    /// The gaits from this one on, as many as a line takes.
    Gaits(GaitId),
    /// The words of the console.
    Words,
    /// What else there is to say to who asks for help.
    Hint,
    /// The end of help, `ok help`.
    Helped,
    /// `ok` and the state of the motion; the next answer continues the line.
    Status,
    /// Counters, faults, restarts and supplies: apart, so that a frame need not wait for
    /// both.
    Health,
    /// A line of what is set, by its number; after the last one `ok cal`.
    Settings(u8),
    /// `err`; nothing was changed.
    Refused(Refusal),
}
