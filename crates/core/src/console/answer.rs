//! Answers: the robot's replies to a line.
//!
//! Every answer ends with exactly one final line, `ok ...` or `err <code> <reason>`; some have other lines before it.

use crate::console::command::LineError;
use crate::control::refusal::Refusal;
use crate::numbers::gaits::GaitId;

/// The next line of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Discriminants start at 1, so that `Option::None` is all zeros: see `Main::new`.
#[repr(u8)]
pub enum Answer {
    /// `ok` and the line as the console understood it.
    Done = 1,
    /// A line of help that lists the gaits from this one on, as many as fit.
    HelpGaits(GaitId),
    /// The line of help that lists the words of the console.
    HelpWords,
    /// The hint that follows the list of commands.
    HelpHint,
    /// The final line of help, `ok help`.
    HelpDone,
    /// The first of the three parts of a `status` line: `ok`, the motion and its pose. Each part is written
    /// separately, so that a frame is delayed by at most one of them.
    Status,
    /// The second part of a `status` line: the margin, whose computation takes most of a frame; the speed; the
    /// frame count.
    StatusMargin,
    /// The last part of a `status` line: counters, faults, restarts and supplies.
    StatusHealth,
    /// The line of `cal` with this index, counted from 0; the last one is `ok cal`.
    Settings(u8),
    /// `err`, since the line is not a valid command; nothing has changed.
    Invalid(LineError),
    /// `err`, since the robot refuses the order; nothing has changed.
    Refused(Refusal),
}

/// The board's counters, as `status` prints them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Number of late pulse edges.
    pub late_edges: u16,
    /// Number of received bytes that were lost or garbled.
    pub rx_lost: u16,
}
