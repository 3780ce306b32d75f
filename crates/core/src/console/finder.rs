//! Detects the baud rate of the sender on the serial line (autobaud).
//!
//! A radio module has a baud rate of its own, which only the received bytes reveal. At a wrong
//! rate, most bytes arrive garbled or are not ASCII. After a few such bytes, the robot tries the next
//! slower rate. So until the sender's rate is reached, the receiver is faster than the
//! sender, and a receiver that is too fast never reads the end of a line.
//!
//! The rate changes only in a pause of the sender, so that the next byte is read from its first bit.

use crate::numbers::rate::BaudRate;

/// The number of wrong bytes after which a rate is abandoned.
const WRONG_BYTE_LIMIT: i8 = 4;

/// The number of additional wrong bytes after which a rate that has carried a command is abandoned: noise, or another
/// sender, must not cut off a robot that is being driven.
const EXTRA_WRONG_BYTES: i8 = 28;

/// The length, in bytes, of the shortest command that is obeyed at a guessed rate, that is, a rate other than USB's
/// that has carried no command yet. A shorter one may be a misread line: some `pose` lines sent at 57 600 baud read as
/// `cal` at 9600.
const MIN_COMMAND_BYTES: usize = 4;

/// The current rate, and the number of wrong bytes received at it.
#[derive(Clone, Copy, Debug)]
pub struct RateFinder {
    rate: BaudRate,
    /// The number of wrong bytes; counts up from `-EXTRA_WRONG_BYTES` after a command, and from 0
    /// after a change of rate.
    wrong_byte_count: i8,
    /// True if a byte has arrived, or may have arrived, since the last frame.
    has_received: bool,
    /// True for a rate other than USB's that has carried no command yet.
    is_guess: bool,
}

impl RateFinder {
    /// Creates a finder that starts with this rate.
    pub const fn new(rate: BaudRate) -> Self {
        Self {
            rate,
            wrong_byte_count: 0,
            has_received: false,
            is_guess: !matches!(rate, BaudRate::Fastest),
        }
    }

    /// Notes a byte. Every byte that is not ASCII counts as wrong, [`crate::console::line::GARBLED_BYTE`] included.
    pub fn note_byte(&mut self, byte: u8) {
        self.has_received = true;
        if !byte.is_ascii() && self.wrong_byte_count < WRONG_BYTE_LIMIT {
            self.wrong_byte_count += 1;
        }
    }

    /// Notes that bytes may have arrived that have not been read yet.
    pub const fn note_unread_bytes(&mut self) {
        self.has_received = true;
    }

    /// Notes a command of this length in bytes. Returns false and notes nothing if the command may be another line
    /// that was read at a wrong rate.
    pub fn note_command(&mut self, length: usize) -> bool {
        if self.is_guess && length < MIN_COMMAND_BYTES {
            return false;
        }
        self.is_guess = false;
        self.wrong_byte_count = -EXTRA_WRONG_BYTES;
        true
    }

    /// Ends a frame. If there have been too many wrong bytes and nothing arrived in this frame, changes to
    /// the next rate and returns it; otherwise returns `None`.
    pub fn end_frame(&mut self) -> Option<BaudRate> {
        let is_pause = !core::mem::take(&mut self.has_received);
        if !is_pause || self.wrong_byte_count < WRONG_BYTE_LIMIT {
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
