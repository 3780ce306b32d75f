//! Faults, and the patterns with which the LED shows them.
//!
//! Without a cable, the LED on D13 is the only indicator. It blinks slowly while there is no fault. After a fault it
//! flashes as many times as the fault's code, pauses, and repeats this until a command moves the robot.

/// A fault, which stops the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// The next pose would have been unsafe.
    Guard = 1,
    /// The supply is too low.
    Supply,
    /// No command has been received within the `deadman` time.
    Link,
    /// The program hung and was restarted.
    Watchdog,
    /// A pulse edge was late. A late rising edge is omitted, so its pulse is missing; a late falling edge makes its
    /// pulse longer.
    LateEdge,
    /// The stack has grown into the data.
    Stack,
    /// A weak supply has caused several consecutive resets. If a boot loader hides the cause of a reset, the reset
    /// button may have caused them.
    BrownOut,
    /// The flash holds no usable robot.
    Robot,
}

impl Fault {
    /// The fault's code: the number of flashes.
    pub const fn code(self) -> u8 {
        self as u8
    }
}

/// Frames for which the LED is lit in each flash, and dark after each flash; a power of two, because one bit of the
/// frame's number tells lit from dark.
const FLASH_FRAMES: u8 = 8;

/// Additional dark frames after the last flash.
const PAUSE_FRAMES: u8 = 48;

/// Frames for which the LED is lit, and then dark, in the heartbeat of a robot without a fault.
const HEARTBEAT_FRAMES: u8 = 32;

/// The pattern that the LED shows.
#[derive(Clone, Copy, Debug, Default)]
pub struct LedPattern {
    /// Frames since the start of the pattern.
    frames: u8,
    /// The fault's code; 0 for the heartbeat.
    code: u8,
}

impl LedPattern {
    /// Creates the pattern at power-on, the heartbeat, which begins lit.
    pub const fn new() -> Self {
        Self { frames: 0, code: 0 }
    }

    /// Advances the pattern by a frame. Returns true if the LED is lit in this frame.
    pub fn advance(&mut self, fault: Option<Fault>) -> bool {
        let code = fault.map_or(0, Fault::code);
        let period = match code {
            0 => 2 * HEARTBEAT_FRAMES,
            code => 2 * FLASH_FRAMES * code + PAUSE_FRAMES,
        };
        if code == self.code {
            self.frames += 1;
        }
        if code != self.code || self.frames >= period {
            *self = Self { frames: 0, code };
        }
        if code == 0 {
            self.frames < HEARTBEAT_FRAMES
        } else {
            self.frames < 2 * FLASH_FRAMES * code && self.frames & FLASH_FRAMES == 0
        }
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::Fault::{BrownOut, Guard, LateEdge, Link, Robot, Stack, Supply, Watchdog};
    use super::*;

    const ALL_FAULTS: [Fault; 8] = [
        Guard, Supply, Link, Watchdog, LateEdge, Stack, BrownOut, Robot,
    ];

    /// True if, according to docs/faults.md, the LED is lit `frame` frames after the start of a pattern. In the pattern
    /// of a fault, the LED flashes as many times as the fault's code, and then pauses.
    fn must_be_lit(fault: Option<Fault>, frame: usize) -> bool {
        let Some(fault) = fault else {
            return frame % 64 < 32;
        };
        let flash_frames = 16 * usize::from(fault.code());
        let frame_in_period = frame % (flash_frames + 48);
        frame_in_period < flash_frames && frame_in_period % 16 < 8
    }

    #[test]
    fn without_a_fault_the_led_shows_the_heartbeat() {
        let mut led = LedPattern::default();
        let led_states = [(); 1000].map(|()| led.advance(None));
        assert!(led_states[0], "the LED is lit first");
        let runs: Vec<&[bool]> = led_states.chunk_by(bool::eq).collect();
        let mut complete_runs = runs[1..runs.len() - 1].iter();
        assert!(complete_runs.all(|run| run.len() == 32));
    }

    #[test]
    fn the_faults_have_the_codes_1_to_8() {
        assert_eq!(ALL_FAULTS.map(Fault::code), [1, 2, 3, 4, 5, 6, 7, 8]);
    }

    #[test]
    fn a_new_pattern_starts_at_once_in_any_frame_of_another_and_repeats() {
        let shown_faults: Vec<Option<Fault>> =
            ALL_FAULTS.into_iter().map(Some).chain([None]).collect();
        for first_fault in &shown_faults {
            for second_fault in shown_faults.iter().filter(|fault| *fault != first_fault) {
                for frames in 1..300 {
                    let mut led = LedPattern::default();
                    for _ in 0..frames {
                        led.advance(*first_fault);
                    }
                    let case = (first_fault, second_fault, frames);
                    for frame in 0..1000 {
                        let is_lit = led.advance(*second_fault);
                        assert_eq!(is_lit, must_be_lit(*second_fault, frame), "{case:?}");
                    }
                }
            }
        }
    }
}
