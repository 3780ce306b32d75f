//! The bytes of RAM that survive a reset.

use core::cell::Cell;
use core::hash::{Hash, Hasher};

use crate::memory::restart::{Cause, Restart};
use crate::memory::retained_ram::{self, CELL_COUNT, Cells};

/// The cells of [`crate::memory::retained_ram`], in the host's memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RetainedRam(Cell<[u8; CELL_COUNT]>);

impl Default for RetainedRam {
    /// Returns the cells after power-on.
    fn default() -> Self {
        let ram = Self(Cell::new([0; CELL_COUNT]));
        ram.begin(Some(Cause::Power));
        ram
    }
}

impl Hash for RetainedRam {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.get().hash(state);
    }
}

impl Cells for RetainedRam {
    fn get(&self, index: usize) -> u8 {
        self.0.get()[index]
    }

    fn set(&self, index: usize, byte: u8) {
        let mut bytes = self.0.get();
        bytes[index] = byte;
        self.0.set(bytes);
    }
}

impl RetainedRam {
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
}
