//! The watchdog: restarts the program when it hangs.
//!
//! The watchdog has its own clock of 128 kHz. If it is not fed for 125 ms, it interrupts the
//! program; after 125 ms more it resets the chip (data sheet, section 11.8). The
//! interrupt handler marks in RAM that the program hung, lets no further pulse begin, and
//! never returns: a program that has hung is not trusted again, even if it could
//! continue. Until the reset, the interrupts of the pulses keep running, so the reset does not
//! cut a pulse short. The mark tells the restarted program the cause of the reset.
//!
//! The watchdog is fed only if the pulse handlers have taken over the previous frame: then main,
//! the clock that woke it and both pulse handlers are alive.

use core::arch::asm;

use super::{kept, pulses};

/// The address of WDTCSR.
const WDTCSR: u8 = 0x60;
/// The value of WDTCSR that permits a change within four cycles.
const ENABLE_CHANGE: u8 = 0x18;
/// The value of WDTCSR that selects an interrupt after 125 ms and a reset after 125 ms more.
const INTERRUPT_THEN_RESET: u8 = 0x4b;

/// Starts the watchdog. Call it once, with interrupts off and WDRF cleared.
pub fn start() {
    // SAFETY: changes only the watchdog. The second store comes two cycles after the first.
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

// The program has hung for 125 ms; the chip resets after 125 ms more.
#[avr_device::interrupt(atmega328p)]
fn WDT() {
    kept::mark_hung();
    pulses::suppress_pulses();
    // SAFETY: every enabled interrupt has a handler. This interrupt does not recur, because the
    // chip has disabled it, and this handler never returns.
    unsafe { avr_device::interrupt::enable() };
    loop {
        avr_device::asm::nop();
    }
}
