//! The transmitter: the robot's output, over a serial line that needs time for each byte.

use core::convert::Infallible;
use core::hash::{Hash, Hasher};
use std::string::String;

use ufmt::uWrite;

/// CPU cycles in a millisecond.
const CYCLES_PER_MS: u64 = 16_000;

/// The transmitter of the serial line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transmitter {
    /// The text that was written and is not read yet.
    pub text: String,
    /// True while nobody reads the line, so that nothing more is sent.
    pub is_held: bool,
    /// CPU cycles per byte; 0 for a line without delay.
    per_byte: u64,
    /// Bytes that the transmitter accepts before a writer has to wait.
    capacity: u64,
    /// The current cycle.
    now: u64,
    /// The cycle at which the last written byte is sent.
    idle_from: u64,
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
        self.cycles_left().hash(state);
    }
}

impl Transmitter {
    /// A line that takes `cycles_per_byte` cycles for a byte, with room for `capacity` bytes.
    pub const fn new(cycles_per_byte: u64, capacity: u64) -> Self {
        Self {
            text: String::new(),
            is_held: false,
            per_byte: cycles_per_byte,
            capacity,
            now: 0,
            idle_from: 0,
        }
    }

    /// Lets milliseconds pass.
    pub(super) const fn pass_time(&mut self, ms: u64) {
        self.now += ms * CYCLES_PER_MS;
    }

    /// Sets the current cycle.
    pub const fn at(&mut self, cycle: u64) {
        self.now = cycle;
    }

    /// The cycle at which the last written byte is sent.
    pub const fn free(&self) -> u64 {
        self.idle_from
    }

    /// Adds bytes that are still to be sent, as if left from an earlier run.
    pub const fn fill(&mut self, bytes: u64) {
        self.idle_from = self.now + bytes * self.per_byte;
    }

    /// Bytes that the transmitter accepts without waiting, at most 255; none while it is held.
    pub fn room(&self) -> u8 {
        if self.is_held {
            return 0;
        }
        let queued = self.cycles_left().div_ceil(self.per_byte.max(1));
        self.capacity.saturating_sub(queued).min(255) as u8
    }

    fn cycles_left(&self) -> u64 {
        self.idle_from.saturating_sub(self.now)
    }

    pub(super) fn reset(self) -> Self {
        Self {
            idle_from: self.now,
            ..self
        }
    }
}

impl uWrite for Transmitter {
    type Error = Infallible;

    fn write_str(&mut self, text: &str) -> Result<(), Infallible> {
        self.text.push_str(text);
        self.idle_from = self.idle_from.max(self.now) + self.per_byte * text.len() as u64;
        Ok(())
    }
}
