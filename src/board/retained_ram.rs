//! The bytes of RAM that survive a reset, because the start-up code does not clear them.
//! [`lizard_core::memory::retained_ram`] defines their contents.

use core::arch::global_asm;

use avr_device::atmega328p::CPU;
use lizard_core::memory::restart::{Cause, Restart, ServoState};
use lizard_core::memory::retained_ram::{self, CELL_COUNT, Cells};
use lizard_core::numbers::rate::BaudRate;
use servo_pulses::cells::SharedByte;

// The start-up code does not clear this section, and the image contains no values for it. A Rust static would put
// initial values into the image.
global_asm!(
    ".pushsection .noinit,\"aw\",@nobits",
    ".global lizard_retained_ram",
    "lizard_retained_ram: .skip {size}",
    ".popsection",
    size = const CELL_COUNT,
);

unsafe extern "C" {
    #[link_name = "lizard_retained_ram"]
    #[allow(improper_ctypes, reason = "no other language uses it")]
    static RETAINED_BYTES: [SharedByte; CELL_COUNT];
}

/// Access to the bytes of [`RETAINED_BYTES`].
struct RetainedRam;

impl Cells for RetainedRam {
    #[inline(always)]
    fn get(&self, index: usize) -> u8 {
        cell(index).get()
    }

    #[inline(always)]
    fn set(&self, index: usize, byte: u8) {
        cell(index).set(byte);
    }
}

/// The byte of [`RETAINED_BYTES`] at an index below `CELL_COUNT`.
#[inline(always)]
fn cell(index: usize) -> &'static SharedByte {
    // SAFETY: a `SharedByte` may have any value, so any contents of the RAM are valid; the core checks them before use,
    // and uses only indices below `CELL_COUNT`.
    unsafe { &*(&raw const RETAINED_BYTES).cast::<SharedByte>().add(index) }
}

/// Returns the information that survived the reset, and marks the program as running. Call this function once, with
/// interrupts off, before the watchdog starts.
pub fn begin(cpu: &CPU) -> Restart {
    let flags = cpu.mcusr.read();
    // Several flags may be set, or no flag if a boot loader has cleared them.
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
    // While WDRF is set, the watchdog cannot be changed.
    cpu.mcusr.reset();
    retained_ram::begin(&RetainedRam, reported_cause)
}

/// Stores the servo state, and the number of consecutive resets that a weak supply may have caused.
pub fn store_servo_state(servo_state: &ServoState, suspected_brown_outs: u8) {
    retained_ram::store_servo_state(&RetainedRam, servo_state, suspected_brown_outs);
}

/// Stores the baud rate.
pub fn store_rate(rate: BaudRate) {
    retained_ram::store_rate(&RetainedRam, rate);
}

/// Marks the program as hung; called by the interrupt handler of the watchdog.
pub fn mark_hung() {
    retained_ram::mark_hung(&RetainedRam);
}
