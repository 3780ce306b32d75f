//! Disturbances from outside the chip: an interrupt that has no source on the chip ([`Uno::block_interrupts`]), a main
//! program that makes no progress ([`Uno::stall_main`]), a register that changes at an arbitrary moment
//! ([`Uno::poke`]).

use crate::Uno;
use crate::ffi;

impl Uno {
    /// Interrupts the program for `cycles`, with priority over all of the chip's own interrupts. Meanwhile the
    /// program executes nothing, but flags are set and bytes arrive. The interruption starts at once, or as soon as
    /// interrupts are enabled. A second call before this start replaces the first call.
    pub fn block_interrupts(&mut self, cycles: u64) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim counts the cycles.
        unsafe { ffi::uno_block_cpu(self.raw, cycles) }
    }

    /// Stops the main program for `cycles`, as if its next instruction took that long. Interrupts are served
    /// meanwhile. While interrupts are disabled, the main program continues until it enables them.
    pub fn stall_main(&mut self, cycles: u64) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim keeps a number.
        unsafe { ffi::uno_stall_main(self.raw, self.cycle() + cycles) }
    }

    /// Writes a byte to a data address (I/O registers or SRAM), as the instruction `sts` would at this moment.
    /// Ignores addresses beyond SRAM.
    pub fn poke(&mut self, address: u16, value: u8) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim writes to a register's handler
        // or inside SRAM and ignores every other address.
        unsafe { ffi::uno_poke(self.raw, address, value) }
    }
}
