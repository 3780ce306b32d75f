//! The robot's answers to a line.
//!
//! Every answer ends with exactly one final line, `ok ...` or `err <code> <reason>`. Some answers have other lines
//! before it.

use crate::console::command::LineError;
use crate::control::refusal::Refusal;
use crate::numbers::gaits::GaitId;

/// A line of an answer, or a part of a line, that is printed in one go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Discriminants start at 1, so that `Option::None` is all zeros: see `Main::new`.
#[repr(u8)]
pub enum AnswerPart {
    /// `ok`, followed by the received line in lower case.
    Done = 1,
    /// A line of help that lists as many gaits as fit, from this one on.
    HelpGaits(GaitId),
    /// The line of help that lists the command words.
    HelpCommands,
    /// The line of help that tells how to get the usage of a command.
    HelpUsage,
    /// The final line of help, `ok help`.
    HelpDone,
    /// The first of the three parts of a `status` line: `ok`, the activity and the pose. Each part is written
    /// separately, so that a frame is delayed by at most one part.
    StatusStart,
    /// The second part of a `status` line: the margin, whose computation takes most of a frame; the speed; and the
    /// frame count.
    StatusMargin,
    /// The last part of a `status` line: counters, faults, resets and supplies.
    StatusHealth,
    /// The line of `cal` with this index, starting at 0; the last line is `ok cal`.
    CalLine(u8),
    /// `err`, because the line is not a valid command; nothing has changed.
    Invalid(LineError),
    /// `err`, because the robot refuses the order; nothing has changed.
    Refused(Refusal),
}

/// The board's counters, which `status` prints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// The number of late pulse edges.
    pub late_edges: u16,
    /// The number of received bytes that were lost or garbled.
    pub rx_lost: u16,
}
