//! Autobaud: detects the baud rate of the sender.
//!
//! Only the received bytes show the baud rate of a radio module. At a wrong rate, most bytes arrive garbled or are not
//! ASCII. After a few such bytes the robot tries the next slower rate. Therefore the receiver is faster than the sender
//! until it has the sender's rate, and a receiver that is too fast never decodes a line end.
//!
//! The rate changes only in a pause of the sender, so that the next byte is received from its first bit.

use crate::numbers::rate::BaudRate;

/// The number of wrong bytes after which a rate is abandoned.
const WRONG_BYTE_LIMIT: i8 = 4;

/// The number of additional wrong bytes after which a confirmed rate is abandoned. Noise or another sender must not
/// disconnect a robot that is being driven.
const EXTRA_WRONG_BYTES: i8 = 28;

/// The length, in bytes, of the shortest command that confirms a guessed rate and is executed. A shorter command may be
/// a misread line: at 9600 baud, some `pose` lines sent at 57 600 baud are decoded as `cal`.
const MIN_COMMAND_BYTES: usize = 4;

/// The current rate, and the number of wrong bytes received at this rate.
#[derive(Clone, Copy, Debug)]
pub struct RateDetector {
    rate: BaudRate,
    /// The number of wrong bytes. The count starts from `-EXTRA_WRONG_BYTES` after a command, and from 0 after a change
    /// of rate.
    wrong_byte_count: i8,
    /// True if a byte may have arrived since the last frame.
    has_received: bool,
    /// True for a rate other than that of USB at which no command has been received yet.
    is_guess: bool,
}

impl RateDetector {
    /// Creates a detector that starts at `rate`.
    pub const fn new(rate: BaudRate) -> Self {
        Self {
            rate,
            wrong_byte_count: 0,
            has_received: false,
            is_guess: !matches!(rate, BaudRate::Fastest),
        }
    }

    /// Records a received byte. A byte that is not ASCII counts as wrong, including
    /// [`crate::console::line::GARBLED_BYTE`].
    pub fn record_byte(&mut self, byte: u8) {
        self.has_received = true;
        if !byte.is_ascii() && self.wrong_byte_count < WRONG_BYTE_LIMIT {
            self.wrong_byte_count += 1;
        }
    }

    /// Records that bytes may have arrived that have not been read yet.
    pub const fn record_unread_bytes(&mut self) {
        self.has_received = true;
    }

    /// Confirms the rate because a command of `length` bytes was received. Returns false and changes nothing if the
    /// command may be another line that was received at a wrong rate.
    pub fn confirm_rate(&mut self, length: usize) -> bool {
        if self.is_guess && length < MIN_COMMAND_BYTES {
            return false;
        }
        self.is_guess = false;
        self.wrong_byte_count = -EXTRA_WRONG_BYTES;
        true
    }

    /// Ends a frame. If there have been too many wrong bytes and no byte arrived in this frame, changes to the next
    /// rate and returns it; otherwise returns `None`.
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
