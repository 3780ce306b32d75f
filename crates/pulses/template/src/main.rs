//! Four servos on pins 9, 10, 11 and 3 of an Arduino UNO swing to and fro once in two seconds, each a quarter of this
//! period after the previous one. The LED blinks with them.

#![no_std]
#![no_main]
#![feature(abi_avr_interrupt)]

use panic_halt as _;
use servo_pulses::{CYCLES_PER_US, Pin};

const PINS: [Pin; 4] = [pin(9), pin(10), pin(11), pin(3)];

const fn pin(number: u8) -> Pin {
    Pin::arduino(number).expect("a UNO has pins 0 to 19")
}

mod servos {
    servo_pulses::engine!(super::PINS);
}

/// Computes the width of the pulse in a frame, in cycles. It grows from 1000 to 2000 us and shrinks back in 100 frames.
fn width_cycles(frame: u8) -> u16 {
    let step = if frame < 50 { frame } else { 100 - frame };
    (1000 + 20 * u16::from(step)) * CYCLES_PER_US
}

#[avr_device::entry]
fn main() -> ! {
    // SAFETY: the engine uses Timer1 and the servos' pins; the LED is on another pin, D13.
    let led = unsafe { avr_device::atmega328p::Peripherals::steal() }.PORTB;
    led.ddrb.write(|w| w.pb5().set_bit());
    // SAFETY: interrupts are off, and nothing else uses Timer1.
    unsafe { servos::start() };
    // SAFETY: every interrupt that is enabled has its handler.
    unsafe { avr_device::interrupt::enable() };
    let mut last_tick = servos::ticks();
    let mut frame = 0;
    loop {
        // After each tick, the program has one frame's time to submit the next widths, which take effect together.
        if servos::ticks() != last_tick {
            last_tick = servos::ticks();
            frame = (frame + 1) % 100;
            servos::submit([0, 25, 50, 75].map(|offset| width_cycles((frame + offset) % 100)));
            if frame % 50 == 0 {
                led.pinb.write(|w| w.pb5().set_bit()); // a one here toggles the pin
            }
        }
    }
}
