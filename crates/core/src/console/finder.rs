//! Finds the baud rate of the sender on the serial line.
//!
//! A radio module has a baud rate of its own, which only the received bytes reveal. At a wrong
//! rate most bytes are garbled, or are bytes that no text contains. After a few of them the next
//! slower rate is tried. So until the sender's rate is reached, the receiver is the faster of the
//! two, and a receiver that is too fast never reads the end of a line.
//!
//! The rate changes only in a pause, so that the next byte is read from its beginning.

use crate::numbers::rate::Rate;

/// Number of wrong bytes after which a rate is given up.
const WRONG_BYTES: i8 = 4;

/// Additional wrong bytes that a rate may have once it has carried a command: noise, or another
/// sender, must not cut off a robot that is being driven.
const EXTRA_WRONG_BYTES: i8 = 28;

/// Least length, in bytes, of a command that is obeyed at a guessed rate, one that has carried no command yet and is
/// not USB's. A shorter one may be misread: some `pose` lines sent at 57 600 baud read as `cal` at 9600.
const MIN_COMMAND_BYTES: usize = 4;

/// The present rate, and the number of wrong bytes received at it.
#[derive(Clone, Copy, Debug)]
pub struct RateFinder {
    rate: Rate,
    /// Number of wrong bytes; it counts up from `-EXTRA_WRONG_BYTES` after a command, and from 0
    /// after a change of rate.
    wrong_bytes: i8,
    /// True if a byte came since the last frame, or may have come.
    has_received: bool,
    /// True for a rate other than USB's that has not carried a command.
    is_guess: bool,
}

impl RateFinder {
    /// A finder that begins with this rate.
    pub const fn new(rate: Rate) -> Self {
        Self {
            rate,
            wrong_bytes: 0,
            has_received: false,
            is_guess: !matches!(rate, Rate::Fastest),
        }
    }

    /// Notes a byte. Every byte that is not ASCII counts as wrong; [`crate::console::line::GARBLED`] is one.
    pub fn note_byte(&mut self, byte: u8) {
        self.has_received = true;
        if !byte.is_ascii() && self.wrong_bytes < WRONG_BYTES {
            self.wrong_bytes += 1;
        }
    }

    /// Notes that bytes may have come that are not read yet.
    pub const fn note_unread(&mut self) {
        self.has_received = true;
    }

    /// Notes a command of this length in bytes; returns false, and notes nothing, if it may be another
    /// line that was read at a wrong rate.
    pub fn note_command(&mut self, length: usize) -> bool {
        if self.is_guess && length < MIN_COMMAND_BYTES {
            return false;
        }
        self.is_guess = false;
        self.wrong_bytes = -EXTRA_WRONG_BYTES;
        true
    }

    /// Ends a frame. If the rate has had too many wrong bytes and nothing came in this frame, changes to
    /// the next rate and returns it; otherwise returns `None`.
    pub fn end_frame(&mut self) -> Option<Rate> {
        let is_pause = !core::mem::take(&mut self.has_received);
        if !is_pause || self.wrong_bytes < WRONG_BYTES {
            return None;
        }
        *self = Self::new(self.rate.next());
        Some(self.rate)
    }
}

#[cfg(test)]
mod misread;
#[cfg(test)]
mod tests;
