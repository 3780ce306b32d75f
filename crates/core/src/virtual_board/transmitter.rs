//! The transmitter: the robot's output over a serial port that takes time for each byte.

use core::convert::Infallible;
use core::hash::{Hash, Hasher};
use std::string::String;

use ufmt::uWrite;

/// CPU cycles in a millisecond.
const CYCLES_PER_MS: u64 = 16_000;

/// The transmitter of the serial port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transmitter {
    /// The text that has been written but not read yet.
    pub text: String,
    /// True while the output is not read, so that no further byte is sent.
    pub is_held: bool,
    /// CPU cycles per byte; 0 for a transmitter that sends at once.
    cycles_per_byte: u64,
    /// The number of bytes that the transmitter accepts before a writer must wait.
    capacity: u64,
    /// The current CPU cycle.
    current_cycle: u64,
    /// The CPU cycle at which all written bytes have been sent.
    idle_from_cycle: u64,
}

impl Default for Transmitter {
    /// Creates a transmitter that sends at once.
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
    /// Creates a transmitter that takes `cycles_per_byte` cycles for a byte and has room for `capacity` bytes.
    pub const fn new(cycles_per_byte: u64, capacity: u64) -> Self {
        Self {
            text: String::new(),
            is_held: false,
            cycles_per_byte,
            capacity,
            current_cycle: 0,
            idle_from_cycle: 0,
        }
    }

    /// Lets milliseconds pass.
    pub(super) const fn pass_time(&mut self, ms: u64) {
        self.current_cycle += ms * CYCLES_PER_MS;
    }

    /// Sets the current CPU cycle.
    pub const fn set_cycle(&mut self, cycle: u64) {
        self.current_cycle = cycle;
    }

    /// The CPU cycle at which all written bytes have been sent.
    pub const fn idle_from_cycle(&self) -> u64 {
        self.idle_from_cycle
    }

    /// Makes `byte_count` bytes wait to be sent, as if they remained from an earlier run.
    pub const fn queue_bytes(&mut self, byte_count: u64) {
        self.idle_from_cycle = self.current_cycle + byte_count * self.cycles_per_byte;
    }

    /// The number of bytes that the transmitter accepts without waiting, at most 255; 0 while the transmitter is held.
    pub fn room(&self) -> u8 {
        if self.is_held {
            return 0;
        }
        let queued_count = self.cycles_left().div_ceil(self.cycles_per_byte.max(1));
        self.capacity.saturating_sub(queued_count).min(255) as u8
    }

    fn cycles_left(&self) -> u64 {
        self.idle_from_cycle.saturating_sub(self.current_cycle)
    }

    pub(super) fn after_reset(self) -> Self {
        Self {
            idle_from_cycle: self.current_cycle,
            ..self
        }
    }
}

impl uWrite for Transmitter {
    type Error = Infallible;

    fn write_str(&mut self, text: &str) -> Result<(), Infallible> {
        self.text.push_str(text);
        self.idle_from_cycle =
            self.idle_from_cycle.max(self.current_cycle) + self.cycles_per_byte * text.len() as u64;
        Ok(())
    }
}
