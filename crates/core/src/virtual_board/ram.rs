//! The bytes of RAM that survive a reset.

use core::cell::Cell;
use core::hash::{Hash, Hasher};

use crate::memory::restart::{Cause, Restart, ServoState};
use crate::memory::retained_ram::{self, CELL_COUNT, Cells};
use crate::numbers::rate::BaudRate;

/// The cells of [`crate::memory::retained_ram`], in the host's memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ram(Cell<[u8; CELL_COUNT]>);

impl Default for Ram {
    /// Returns the cells after power-on.
    fn default() -> Self {
        let ram = Self(Cell::new([0; CELL_COUNT]));
        ram.begin(Some(Cause::Power));
        ram
    }
}

impl Hash for Ram {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.get().hash(state);
    }
}

impl Cells for Ram {
    fn get(&self, index: usize) -> u8 {
        self.0.get()[index]
    }

    fn set(&self, index: usize, byte: u8) {
        let mut bytes = self.0.get();
        bytes[index] = byte;
        self.0.set(bytes);
    }
}

impl Ram {
    /// Returns the information that the program would read if it started now, without changing the cells.
    /// `reported_cause` is the cause that the chip reports, or `None` if a boot loader hides the cause.
    pub fn peek_restart(&self, reported_cause: Option<Cause>) -> Restart {
        retained_ram::begin(&self.clone(), reported_cause)
    }

    /// Returns the information that survived the reset, and marks the program as running, as the firmware does when it
    /// starts. `reported_cause` is the cause that the chip reports, or `None` if a boot loader hides the cause.
    pub fn begin(&self, reported_cause: Option<Cause>) -> Restart {
        retained_ram::begin(self, reported_cause)
    }

    /// Stores the servo state, and the number of consecutive resets that a weak supply may have caused.
    pub fn store_servo_state(&self, servo_state: &ServoState, suspected_brown_outs: u8) {
        retained_ram::store_servo_state(self, servo_state, suspected_brown_outs);
    }

    /// Stores the baud rate.
    pub fn store_rate(&self, rate: BaudRate) {
        retained_ram::store_rate(self, rate);
    }

    /// Marks the program as hung.
    pub fn mark_hung(&self) {
        retained_ram::mark_hung(self);
    }
}
