//! The pulses of the four servos and the 50 Hz clock: the engine of `servo-pulses`. `later: 4` means four servos whose
//! pins become known only when the robot's section has been read.
//!
//! The documentation of `servo-pulses` explains the generation of pulses that are exact to the cycle, and the rules for
//! all other interrupts. With four servos, a slot is 4 ms, a frame 20 ms; the main loop has 3.9 ms to compute a frame.

use servo_pulses::Pin;

servo_pulses::engine!(later: 4);

/// Connects the servos A1 to A4 to the pins with these Arduino numbers. All four pins exist, because
/// [`lizard_core::numbers::robot::Robot::open`] rejects any other number.
#[inline(always)]
pub fn connect_pins(numbers: [u8; 4]) {
    if let [Some(a1), Some(a2), Some(a3), Some(a4)] = numbers.map(Pin::arduino) {
        connect([a1, a2, a3, a4]);
    }
}
