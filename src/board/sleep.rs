//! Sleep of the processor until there is a task.
//!
//! If an interrupt occurred between the check for tasks and the `sleep` instruction, a task would wait until the next
//! interrupt, for up to 4 ms. Therefore interrupts are off during the check. `sei` allows interrupts only after the
//! next instruction, which is `sleep`.

use core::arch::asm;

use avr_device::atmega328p::CPU;
use avr_device::interrupt;

use super::{pulses, serial};

/// Selects idle mode, in which the timer and the USART continue. Call this function once.
pub fn start(cpu: CPU) {
    cpu.smcr.write(|w| w.sm().idle().se().set_bit());
}

/// Sleeps until the count of ticks differs from `ticks`, a received byte waits, or the send buffer becomes empty, so
/// that the next line has room. Interrupts are off for fewer than 40 cycles at a time.
pub fn wait_for_event(ticks: u8) {
    let was_sending = serial::is_sending();
    loop {
        interrupt::disable();
        if pulses::ticks() != ticks || serial::has_input() || was_sending && !serial::is_sending() {
            break;
        }
        // The `nop` is for stock simavr, which accepts an interrupt one instruction later than the chip. Without the
        // `nop`, the next `cli` would block all interrupts permanently in stock simavr.
        // SAFETY: interrupts were on before the call of `disable`, and every enabled interrupt has a handler.
        unsafe { asm!("sei", "sleep", "nop", options(nostack, preserves_flags)) };
    }
    // SAFETY: as above.
    unsafe { interrupt::enable() };
}
