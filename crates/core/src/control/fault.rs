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

/// Frames for which the LED is lit in each flash, and dark after each flash.
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

    use super::*;

    const ALL_FAULTS: [Fault; 8] = [
        Fault::Guard,
        Fault::Supply,
        Fault::Link,
        Fault::Watchdog,
        Fault::LateEdge,
        Fault::Stack,
        Fault::BrownOut,
        Fault::Robot,
    ];

    /// Advances the LED by `frames` frames. Returns its runs of equal frames: true for a lit run, and the length of the
    /// run.
    fn record_runs(
        led: &mut LedPattern,
        fault: Option<Fault>,
        frames: usize,
    ) -> Vec<(bool, usize)> {
        let mut runs: Vec<(bool, usize)> = Vec::new();
        for _ in 0..frames {
            let is_lit_now = led.advance(fault);
            match runs.last_mut() {
                Some((was_lit, count)) if *was_lit == is_lit_now => *count += 1,
                _ => runs.push((is_lit_now, 1)),
            }
        }
        runs
    }

    /// True if, according to docs/faults.md, the LED is lit `frame` frames after the start of a pattern.
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
        let runs = record_runs(&mut LedPattern::default(), None, 1000);
        assert!(runs[0].0, "the LED is lit first");
        let mut complete_runs = runs[1..runs.len() - 1].iter();
        assert!(complete_runs.all(|(_, frames)| *frames == 32));
    }

    #[test]
    fn the_led_flashes_as_many_times_as_the_faults_code_and_then_pauses() {
        for (index, fault) in ALL_FAULTS.into_iter().enumerate() {
            assert_eq!(usize::from(fault.code()), index + 1);
            let mut led = LedPattern::default();
            record_runs(&mut led, None, 13 * (index + 1));
            let runs = record_runs(&mut led, Some(fault), 1000);
            // Pauses separate the patterns.
            let mut flash_count = 0;
            let mut flash_counts = Vec::new();
            for (is_lit, frames) in &runs[..runs.len() - 1] {
                match (is_lit, frames) {
                    (true, 8) => flash_count += 1,
                    (false, 8) => {}
                    (false, 56) => {
                        flash_counts.push(flash_count);
                        flash_count = 0;
                    }
                    run => panic!("{fault:?}: {run:?}"),
                }
            }
            assert!(flash_counts.len() >= 5, "{fault:?} {runs:?}");
            assert!(flash_counts.iter().all(|n| *n == index + 1), "{fault:?}");
        }
    }

    #[test]
    fn any_pattern_replaces_any_other_at_once_at_every_frame() {
        let shown_faults: Vec<Option<Fault>> =
            ALL_FAULTS.into_iter().map(Some).chain([None]).collect();
        for first_fault in &shown_faults {
            for second_fault in shown_faults.iter().filter(|fault| *fault != first_fault) {
                for frames in 1..300 {
                    let mut led = LedPattern::default();
                    record_runs(&mut led, *first_fault, frames);
                    for frame in 0..400 {
                        let is_lit = led.advance(*second_fault);
                        assert_eq!(
                            is_lit,
                            must_be_lit(*second_fault, frame),
                            "{first_fault:?} {second_fault:?} {frames}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn the_pattern_of_a_second_fault_starts_with_a_whole_flash() {
        let mut led = LedPattern::default();
        record_runs(&mut led, Some(Fault::Stack), 100);
        let runs = record_runs(&mut led, Some(Fault::Guard), 10);
        assert_eq!(runs, [(true, 8), (false, 2)]);
        assert_eq!(record_runs(&mut led, None, 40), [(true, 32), (false, 8)]);
    }
}
