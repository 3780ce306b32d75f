//! The RAM bytes that survive a reset.

use core::cell::Cell;
use core::hash::{Hash, Hasher};

use crate::memory::kept::{self, CELLS, Cells};
use crate::memory::restart::{Cause, Restart, Stance};
use crate::numbers::rate::Rate;

/// The cells of [`crate::memory::kept`], in the host's memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ram(Cell<[u8; CELLS]>);

impl Default for Ram {
    /// The cells just after power-on.
    fn default() -> Self {
        let ram = Self(Cell::new([0; CELLS]));
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
    /// The state that the program would find if it started now; changes nothing. `reported` is the cause that the
    /// chip reports, or `None` if a boot loader hides it.
    pub fn peek_restart(&self, reported: Option<Cause>) -> Restart {
        kept::begin(&self.clone(), reported)
    }

    /// Returns the cause of the reset and the state from before it, and marks the program as running, as the
    /// firmware does at its start. `reported` is the cause that the chip reports, or `None` if a boot loader hides
    /// it.
    pub fn begin(&self, reported: Option<Cause>) -> Restart {
        kept::begin(self, reported)
    }

    /// Stores the servos' state.
    pub fn store_stance(&self, stance: &Stance, brown_outs: u8) {
        kept::store_stance(self, stance, brown_outs);
    }

    /// Stores the rate of the serial line.
    pub fn store_rate(&self, rate: Rate) {
        kept::store_rate(self, rate);
    }

    /// Marks the program as hung.
    pub fn mark_hung(&self) {
        kept::mark_hung(self);
    }
}
