//! Disturbances that can happen to any board: see [`Uno::hold`].

use crate::Uno;
use crate::ffi;

impl Uno {
    /// An interrupt out of nowhere that takes `cycles`: nothing is executed
    /// meanwhile, flags go up and bytes come. It comes before all the chip's own
    /// interrupts; now, or as soon as interrupts are on. A second call before that
    /// replaces the first.
    pub fn hold(&mut self, cycles: u64) {
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim counts the cycles.
        unsafe { ffi::uno_hold(self.raw, cycles) }
    }

    /// Main executes nothing for this many cycles, as if the instruction that is next
    /// took that long; interrupts are served all the time. While main keeps them
    /// off it does go on.
    pub fn stall_main(&mut self, cycles: u64) {
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim keeps a number.
        unsafe { ffi::uno_stall_main(self.raw, self.cycle() + cycles) }
    }

    /// Writes a byte to a data address (I/O registers or SRAM) as an `sts` would
    /// at this moment. Nothing happens beyond SRAM.
    pub fn poke(&mut self, address: u16, value: u8) {
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim writes to a
        // register's handler or inside SRAM and ignores every other address.
        unsafe { ffi::uno_poke(self.raw, address, value) }
    }
}
