//! Sleep until there is something to do.
//!
//! If an interrupt came between the check for work and the `sleep` instruction, the
//! program would sleep through it, for up to 4 ms. So the check is made with interrupts
//! off. `sei` allows them only after one more instruction, which is `sleep`.

use core::arch::asm;

use avr_device::atmega328p::CPU;
use avr_device::interrupt;

use super::{pulses, serial};

/// Chooses idle, the sleep in which the timer and the USART run on. To be called once.
pub fn start(cpu: CPU) {
    cpu.smcr.write(|w| w.sm().idle().se().set_bit());
}

/// Sleeps until the tick is no longer this one, a byte waits to be read, or the last byte to
/// be sent is on its way, which leaves room for the next line. Interrupts are off for fewer
/// than 40 cycles at a time.
pub fn until_tick_or_byte(tick: u8) {
    let was_sending = serial::is_sending();
    loop {
        interrupt::disable();
        if pulses::ticks() != tick || serial::has_input() || was_sending && !serial::is_sending() {
            break;
        }
        // The `nop` is for stock simavr, which lets interrupts in an instruction
        // later than the data sheet: `cli`, next, would lock them out for good.
        // SAFETY: interrupts were on before `disable`, above, and every one of
        // them has its handler.
        unsafe { asm!("sei", "sleep", "nop", options(nostack, preserves_flags)) };
    }
    // SAFETY: as above.
    unsafe { interrupt::enable() };
}
