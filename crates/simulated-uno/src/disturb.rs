//! Disturbances from outside: an interrupt of no source on the chip ([`Uno::hold`]), a main
//! program that makes no progress, a register changed at any moment.

use crate::Uno;
use crate::ffi;

impl Uno {
    /// Interrupts the program for `cycles`, in which it executes nothing, while flags are set and
    /// bytes arrive. This interrupt has priority over all the chip's own; it is served
    /// now, or as soon as interrupts are on. A second call before that replaces the first.
    pub fn hold(&mut self, cycles: u64) {
        // SAFETY: `raw` is valid and ours alone, see `Uno`; the shim counts the cycles.
        unsafe { ffi::uno_hold(self.raw, cycles) }
    }

    /// Stops main for this many cycles, as if its next instruction took that long; interrupts are
    /// served all the time. While main keeps them off, it continues.
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
