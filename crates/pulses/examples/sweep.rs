//! Eight servos sweep, each at its own speed, while the LED blinks and every byte received at 115 200 baud is echoed.
//! This is a complete program for an Arduino UNO.
//!
//! `make sweep` builds the program; the tests run it on the simulated UNO, which measures every pulse.

#![no_std]
#![no_main]
#![feature(abi_avr_interrupt)]
#![allow(unsafe_code)] // Writing registers and enabling interrupts need it.

use avr_device::atmega328p::{Peripherals, USART0};
use panic_halt as _;
use servo_pulses::cells::SharedByte;
use servo_pulses::{CYCLES_PER_US, Pin};

/// The pins of eight servos on three ports. The LED is on D13, the serial port on D0 and D1.
const PINS: [Pin; 8] = [
    pin(2),
    pin(3),
    pin(7),
    pin(8),
    pin(9),
    pin(12),
    pin(14), // A0
    pin(19), // A5
];

const fn pin(number: u8) -> Pin {
    Pin::arduino(number).expect("a UNO has pins 0 to 19")
}

mod servos {
    // The pins are connected at run time. `engine!(super::PINS)` would set them at compile time.
    servo_pulses::engine!(later: 8);
}

/// The ring buffer of received bytes.
static RECEIVE_RING: [SharedByte; 16] = [const { SharedByte::new(0) }; 16];
/// The number of received bytes, modulo 256, which the handler increments; `main` echoes bytes until it has echoed as
/// many.
static RECEIVED_COUNT: SharedByte = SharedByte::new(0);

/// Computes the width of a servo's pulse in a frame, in cycles: a triangle wave from 1000 to 2000 us, which changes by
/// a different number of cycles per frame for each servo.
fn width_cycles(servo: u8, frame: u16) -> u16 {
    let cycles_per_frame = 16 * u16::from(servo) + 5;
    let ramp = frame.wrapping_mul(cycles_per_frame) % 32_000;
    let added_cycles = if ramp < 16_000 { ramp } else { 32_000 - ramp };
    1000 * CYCLES_PER_US + added_cycles
}

#[avr_device::entry]
fn main() -> ! {
    // SAFETY: only the boot loader has run before this call.
    let chip = unsafe { Peripherals::steal() };
    // 16 MHz / 8 / (16 + 1) = 117 647 baud, as in the boot loader; 8N1.
    chip.USART0.ucsr0a.write(|w| w.u2x0().set_bit());
    chip.USART0.ubrr0.write(|w| w.bits(16));
    chip.USART0
        .ucsr0b
        .write(|w| w.rxen0().set_bit().txen0().set_bit().rxcie0().set_bit());
    chip.PORTB.ddrb.modify(|_, w| w.pb5().set_bit());
    servos::connect(PINS);
    // SAFETY: interrupts are off, and nothing else uses Timer1.
    unsafe { servos::start() };
    // SAFETY: every interrupt that is enabled above has its handler.
    unsafe { avr_device::interrupt::enable() };
    let (mut last_tick, mut frame, mut echoed_count) = (servos::ticks(), 0u16, 0u8);
    loop {
        if servos::ticks() != last_tick {
            last_tick = servos::ticks();
            let mut widths = [0; PINS.len()];
            for (servo, width) in widths.iter_mut().enumerate() {
                *width = width_cycles(servo as u8, frame);
            }
            servos::submit(widths);
            frame = frame.wrapping_add(1);
            // Toggles the LED in one instruction, because PORTB also has servo pins.
            if last_tick & 15 == 0 {
                // SAFETY: a one in this register toggles a pin of PORTB.
                unsafe { chip.PORTB.pinb.write(|w| w.bits(1 << 5)) };
            }
        }
        if RECEIVED_COUNT.get() != echoed_count && chip.USART0.ucsr0a.read().udre0().bit_is_set() {
            let byte = RECEIVE_RING[usize::from(echoed_count & 15)].get();
            echoed_count = echoed_count.wrapping_add(1);
            chip.USART0.udr0.write(|w| w.bits(byte));
        }
    }
}

#[avr_device::interrupt(atmega328p)]
fn USART_RX() {
    // SAFETY: only this handler reads UDR0.
    let byte = unsafe { &*USART0::ptr() }.udr0.read().bits();
    let received_count = RECEIVED_COUNT.get();
    RECEIVE_RING[usize::from(received_count & 15)].set(byte);
    RECEIVED_COUNT.set(received_count.wrapping_add(1));
}
