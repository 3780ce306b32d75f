//! The transmitter: the robot's output, and a line that takes its time.

use core::convert::Infallible;
use core::hash::{Hash, Hasher};
use std::string::String;

use ufmt::uWrite;

/// CPU cycles of a millisecond.
const MS: u64 = 16_000;

/// The transmitter of the serial line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transmitter {
    /// The text that was written and not read yet.
    pub text: String,
    /// True while nobody reads the line, so that it never gets free.
    pub is_held: bool,
    /// CPU cycles for a byte; 0 for a line without delay.
    per_byte: u64,
    /// Bytes that it accepts before a writer has to wait.
    capacity: u64,
    /// The present cycle.
    now: u64,
    /// The cycle at which everything written has been sent.
    free: u64,
}

impl Default for Transmitter {
    /// A line without delay.
    fn default() -> Self {
        Self::new(0, 255)
    }
}

impl Hash for Transmitter {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.text.hash(state);
        self.is_held.hash(state);
        self.left().hash(state);
    }
}

impl Transmitter {
    /// A line that takes this many cycles for a byte, with room for this many bytes.
    pub const fn new(per_byte: u64, capacity: u64) -> Self {
        Self {
            text: String::new(),
            is_held: false,
            per_byte,
            capacity,
            now: 0,
            free: 0,
        }
    }

    /// Lets milliseconds pass.
    pub(super) const fn pass_time(&mut self, ms: u64) {
        self.now += ms * MS;
    }

    /// Sets the present cycle.
    pub const fn at(&mut self, cycle: u64) {
        self.now = cycle;
    }

    /// The cycle at which everything written has been sent.
    pub const fn free(&self) -> u64 {
        self.free
    }

    /// Adds bytes from an earlier run that are still to be sent.
    pub const fn fill(&mut self, bytes: u64) {
        self.free = self.now + bytes * self.per_byte;
    }

    /// Bytes that it takes without waiting, at most 255.
    pub fn room(&self) -> u8 {
        if self.is_held {
            return 0;
        }
        let queued = self.left().div_ceil(self.per_byte.max(1));
        self.capacity.saturating_sub(queued).min(255) as u8
    }

    fn left(&self) -> u64 {
        self.free.saturating_sub(self.now)
    }

    pub(super) fn reset(self) -> Self {
        Self {
            free: self.now,
            ..self
        }
    }
}

impl uWrite for Transmitter {
    type Error = Infallible;

    fn write_str(&mut self, text: &str) -> Result<(), Infallible> {
        self.text.push_str(text);
        self.free = self.free.max(self.now) + self.per_byte * text.len() as u64;
        Ok(())
    }
}
