//! The four servos' pulses and the 50 Hz clock: the engine of `servo-pulses`, with the
//! robot's pins.
//!
//! How they are exact to the cycle, and what the other interrupts owe to that, is said
//! there. With four servos a slot is 4 ms and a frame 20 ms; main has 3.9 ms for one.

use servo_pulses::Pin;

use crate::robot::PINS as NUMBERS;

/// The pins of A1 to A4.
const SERVO_PINS: [Pin; 4] = [
    pin(NUMBERS[0]),
    pin(NUMBERS[1]),
    pin(NUMBERS[2]),
    pin(NUMBERS[3]),
];

/// The serial line has D0 and D1, the LED D13.
const fn pin(number: u8) -> Pin {
    match Pin::arduino(number) {
        Some(pin) if number >= 2 && number != 13 => pin,
        _ => panic!("a servo goes to one of D2 to D12 or A0 to A5"),
    }
}

servo_pulses::engine!(SERVO_PINS);
