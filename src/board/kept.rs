//! The bytes of RAM that survive a reset, since the start-up code does not clear them.
//! [`lizard_core::memory::retained_ram`] defines their contents.

use core::arch::global_asm;

use avr_device::atmega328p::CPU;
use lizard_core::memory::restart::{Cause, Restart, Stance};
use lizard_core::memory::retained_ram::{self, CELL_COUNT, Cells};
use lizard_core::numbers::rate::BaudRate;

use servo_pulses::cells::Byte;

// The start-up code does not clear the section, and the image holds no values for it. A Rust static would put initial
// values into the image.
global_asm!(
    ".pushsection .noinit,\"aw\",@nobits",
    ".global lizard_kept",
    "lizard_kept: .skip {size}",
    ".popsection",
    size = const CELL_COUNT,
);

unsafe extern "C" {
    #[link_name = "lizard_kept"]
    #[allow(improper_ctypes, reason = "no other language sees it")]
    static KEPT: [Byte; CELL_COUNT];
}

/// Access to the bytes of [`KEPT`].
struct Ram;

impl Cells for Ram {
    #[inline(always)]
    fn get(&self, index: usize) -> u8 {
        cell(index).get()
    }

    #[inline(always)]
    fn set(&self, index: usize, byte: u8) {
        cell(index).set(byte);
    }
}

/// The byte of [`KEPT`] at an index below `CELL_COUNT`.
#[inline(always)]
fn cell(index: usize) -> &'static Byte {
    // SAFETY: a `Byte` may have any value, so whatever the RAM holds is valid; the core checks it before use, and
    // uses only indices below `CELL_COUNT`.
    unsafe { &*(&raw const KEPT).cast::<Byte>().add(index) }
}

/// Returns the cause of the reset and the state from before it, and marks the program as
/// running. Call it once, with interrupts off, before the watchdog starts.
pub fn start(cpu: &CPU) -> Restart {
    let flags = cpu.mcusr.read();
    // Several flags may be set; no flag is set if a boot loader has cleared them.
    let reported_cause = if flags.porf().bit_is_set() {
        Some(Cause::Power)
    } else if flags.wdrf().bit_is_set() {
        Some(Cause::Watchdog)
    } else if flags.borf().bit_is_set() {
        Some(Cause::BrownOut)
    } else if flags.extrf().bit_is_set() {
        Some(Cause::External)
    } else {
        None
    };
    // The watchdog cannot be changed while WDRF is set.
    cpu.mcusr.reset();
    retained_ram::begin(&Ram, reported_cause)
}

/// Stores the servos' state.
pub fn store_stance(stance: &Stance, brown_outs: u8) {
    retained_ram::store_stance(&Ram, stance, brown_outs);
}

/// Stores the baud rate of the serial line.
pub fn store_rate(rate: BaudRate) {
    retained_ram::store_rate(&Ram, rate);
}

/// Marks the program as hung; called by the watchdog's interrupt.
pub fn mark_hung() {
    retained_ram::mark_hung(&Ram);
}
