//! Finds the rate at which others send.
//!
//! A radio module has a rate of its own, which only the bytes themselves reveal. At a
//! wrong rate most bytes come garbled or occur in no text. After a few of them the next
//! slower rate is tried. Up to the sender's own rate, the receiver is then always the faster of
//! the two, which never reads the end of a line.
//!
//! The rate changes only in a pause, so that the next byte is read from its beginning.

use crate::numbers::rate::Rate;

/// Wrong bytes after which a rate is left.
const WRONG_BYTES: i8 = 4;

/// Additional wrong bytes for a rate that has carried a command: noise, or another sender,
/// must not cut off a robot that is being driven.
const MORE_AFTER_COMMAND: i8 = 28;

/// Length of the shortest command that is obeyed at a rate that has carried none, bytes. Some `pose`
/// lines at 57 600 baud read as `cal` at 9600.
const MIN_COMMAND_BYTES: usize = 4;

/// The present rate, and the wrong bytes at it.
#[derive(Clone, Copy, Debug)]
pub struct RateFinder {
    rate: Rate,
    /// Wrong bytes since the last command, from `-MORE_AFTER_COMMAND` on, or since the last change
    /// of rate, from 0 on.
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

    /// Takes a byte; any that is not ASCII is wrong, so [`crate::console::line::GARBLED`] is.
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

    /// Takes a command of this length; returns false if it may be a misread one.
    pub fn note_command(&mut self, length: usize) -> bool {
        if self.is_guess && length < MIN_COMMAND_BYTES {
            return false;
        }
        self.is_guess = false;
        self.wrong_bytes = -MORE_AFTER_COMMAND;
        true
    }

    /// Changes the rate if it must be wrong and nothing came in this frame; returns the new one.
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
