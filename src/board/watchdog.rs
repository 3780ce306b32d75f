//! The watchdog, which restarts a program that hangs.
//!
//! The watchdog has its own clock of 128 kHz. If it is not fed for 125 ms, it interrupts the program; after 125 ms more
//! it resets the chip (data sheet, section 11.8). The interrupt handler marks the program as hung in RAM, prevents
//! further pulses, and never returns, because a program that has hung cannot be trusted, even if it could continue.
//! Until the reset, the interrupts of the pulses continue, so that the reset does not shorten a pulse. From the mark,
//! the restarted program determines the cause of the reset.
//!
//! The watchdog is fed only if the pulse handlers have taken over the previous frame: main, the clock that woke main
//! and both pulse handlers are then running.

use core::arch::asm;

use super::{pulses, retained_ram};

/// The address of WDTCSR.
const WDTCSR: u8 = 0x60;
/// The value of WDTCSR that enables a change within four cycles.
const ENABLE_CHANGE: u8 = 0x18;
/// The value of WDTCSR that selects an interrupt after 125 ms and a reset after 125 ms more.
const INTERRUPT_THEN_RESET: u8 = 0x4b;

/// Starts the watchdog. Call this function once, with interrupts off and WDRF cleared.
pub fn start() {
    // SAFETY: changes only the watchdog. The second store is made two cycles after the first.
    unsafe {
        asm!(
            "wdr",
            "sts {wdtcsr}, {change}",
            "sts {wdtcsr}, {mode}",
            wdtcsr = const WDTCSR,
            change = in(reg) ENABLE_CHANGE,
            mode = in(reg) INTERRUPT_THEN_RESET,
            options(nostack, preserves_flags),
        );
    }
}

/// Feeds the watchdog, which then waits another 125 ms.
pub fn feed() {
    avr_device::asm::wdr();
}

// Handles a program that has hung for 125 ms; the chip resets after 125 ms more.
#[avr_device::interrupt(atmega328p)]
fn WDT() {
    retained_ram::mark_hung();
    pulses::suppress_pulses();
    // SAFETY: every enabled interrupt has a handler. This interrupt does not recur, because the chip has disabled it,
    // and this handler never returns.
    unsafe { avr_device::interrupt::enable() };
    loop {
        avr_device::asm::nop();
    }
}
