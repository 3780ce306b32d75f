//! Sleep of the processor until there is something to do.
//!
//! If an interrupt came between the check for work and the `sleep` instruction, the
//! program would sleep until the next interrupt, up to 4 ms, with work waiting. So the check is made with
//! interrupts off. `sei` allows interrupts only after one more instruction, which is `sleep`.

use core::arch::asm;

use avr_device::atmega328p::CPU;
use avr_device::interrupt;

use super::{pulses, serial};

/// Selects idle mode, in which the timer and the USART keep running. Call it once.
pub fn start(cpu: CPU) {
    cpu.smcr.write(|w| w.sm().idle().se().set_bit());
}

/// Sleeps until the count of ticks differs from `tick`, a byte waits to be read, or the send buffer
/// becomes empty, so that the next line has room. Interrupts are off for fewer than 40 cycles at a time.
pub fn until_tick_or_byte(tick: u8) {
    let was_sending = serial::is_sending();
    loop {
        interrupt::disable();
        if pulses::ticks() != tick || serial::has_input() || was_sending && !serial::is_sending() {
            break;
        }
        // The `nop` is for stock simavr, which accepts an interrupt one instruction later than the chip: there, the
        // `cli` that follows would otherwise block all interrupts for good.
        // SAFETY: interrupts were on before `disable`, above, and every enabled one
        // has a handler.
        unsafe { asm!("sei", "sleep", "nop", options(nostack, preserves_flags)) };
    }
    // SAFETY: as above.
    unsafe { interrupt::enable() };
}
