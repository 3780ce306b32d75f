//! Answers: the robot's replies to a line.
//!
//! Every line gets exactly one final line, `ok ...` or `err <code> <reason>`; some
//! answers have other lines before it.

use crate::console::command::Misread;
use crate::control::refusal::Refusal;
use crate::numbers::gaits::GaitId;

/// The next line of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Starts at 1, since `None` has to be zero: see `Main::new`.
#[repr(u8)]
pub enum Answer {
    /// `ok` and the line as the console understood it.
    Done = 1,
    /// The gaits from this one on, as many as fit in a line.
    HelpGaits(GaitId),
    /// The words of the console.
    HelpWords,
    /// The hint that ends the list of commands.
    HelpHint,
    /// The end of help, `ok help`.
    HelpDone,
    /// `ok`, the motion and its pose: the first of the three parts of a `status` line. Each part is written
    /// separately, so that a frame is delayed by at most one of them.
    Status,
    /// The second part of a `status` line: the margin, whose measurement takes most of a frame; the pace; the
    /// frame count.
    StatusMargin,
    /// The last part of a `status` line: counters, faults, restarts and supplies.
    StatusHealth,
    /// A line of the settings, by its number; the line after the settings is `ok cal`.
    Settings(u8),
    /// `err`, since the line is not a command; nothing was changed.
    Misread(Misread),
    /// `err`, since the robot refuses the order; nothing was changed.
    Refused(Refusal),
}

/// The board's counters, as `status` prints them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Pulse edges that came late.
    pub late_edges: u16,
    /// Received bytes that were lost.
    pub rx_lost: u16,
}
