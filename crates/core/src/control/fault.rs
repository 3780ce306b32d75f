//! Faults, and the patterns by which the LED shows them.
//!
//! Without a cable, the LED on D13 is all that a person sees. It blinks slowly while all
//! is well. After a fault it flashes as many times as the fault's code, pauses, and
//! repeats that until the robot is told to move.

/// A fault. Each of them stops the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// The next pose would not have been safe.
    Guard = 1,
    /// The supply is too low.
    Supply,
    /// No command has come for as long as `deadman` allows.
    Link,
    /// The program hung and was restarted.
    Watchdog,
    /// An edge of a pulse came late. A late rising edge is left out, so its pulse is
    /// missing; a late falling edge makes its pulse longer.
    Late,
    /// The stack has grown into the data.
    Stack,
    /// Several resets in a row by a weak supply or, where a boot loader hides the cause, by the
    /// button.
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

/// Frames for which a flash is lit, and frames for which the LED is dark after it.
const FLASH_FRAMES: u8 = 8;

/// Frames of the pause after the flashes.
const PAUSE_FRAMES: u8 = 48;

/// Frames for which the slow beat of a robot without a fault is lit, and then dark.
const BEAT_FRAMES: u8 = 32;

/// The pattern that the LED shows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Led {
    /// Frames since the pattern began.
    frames: u8,
    /// The pattern's code, 0 for the slow beat.
    code: u8,
}

impl Led {
    /// At power-on: the slow beat, lit first.
    pub const fn new() -> Self {
        Self { frames: 0, code: 0 }
    }

    /// Advances the pattern by a frame; true if the LED is lit in it.
    pub fn advance(&mut self, fault: Option<Fault>) -> bool {
        let code = fault.map_or(0, Fault::code);
        let period = match code {
            0 => 2 * BEAT_FRAMES,
            code => 2 * FLASH_FRAMES * code + PAUSE_FRAMES,
        };
        if code == self.code {
            self.frames += 1;
        }
        if code != self.code || self.frames >= period {
            *self = Self { frames: 0, code };
        }
        if code == 0 {
            self.frames < BEAT_FRAMES
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
        Fault::Late,
        Fault::Stack,
        Fault::BrownOut,
        Fault::Robot,
    ];

    /// The LED's lit and dark runs over some frames: true for a lit one, and its length.
    fn record_runs(led: &mut Led, fault: Option<Fault>, frames: usize) -> Vec<(bool, usize)> {
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

    /// The LED's state according to docs/faults.md, `frame` frames after a pattern began.
    fn should_be_lit(fault: Option<Fault>, frame: usize) -> bool {
        let Some(fault) = fault else {
            return frame % 64 < 32;
        };
        let flashes = 16 * usize::from(fault.code());
        let frame_in_period = frame % (flashes + 48);
        frame_in_period < flashes && frame_in_period % 16 < 8
    }

    #[test]
    fn without_a_fault_it_beats_slowly() {
        let runs = record_runs(&mut Led::default(), None, 1000);
        assert!(runs[0].0, "lit first");
        assert!(
            runs[1..runs.len() - 1]
                .iter()
                .all(|(_, frames)| *frames == 32)
        );
    }

    #[test]
    fn a_fault_flashes_as_often_as_its_code_says_and_pauses() {
        for (index, fault) in ALL_FAULTS.into_iter().enumerate() {
            assert_eq!(usize::from(fault.code()), index + 1);
            let mut led = Led::default();
            record_runs(&mut led, None, 13 * (index + 1));
            let runs = record_runs(&mut led, Some(fault), 1000);
            // The pauses separate the patterns.
            let mut flashes = 0;
            let mut patterns = Vec::new();
            for (is_lit, frames) in &runs[..runs.len() - 1] {
                match (is_lit, frames) {
                    (true, 8) => flashes += 1,
                    (false, 8) => {}
                    (false, 56) => {
                        patterns.push(flashes);
                        flashes = 0;
                    }
                    run => panic!("{fault:?}: {run:?}"),
                }
            }
            assert!(patterns.len() >= 5, "{fault:?} {runs:?}");
            assert!(patterns.iter().all(|n| *n == index + 1), "{fault:?}");
        }
    }

    /// A pattern may be interrupted at any frame.
    #[test]
    fn any_pattern_begins_at_once_at_any_frame_of_any_other_and_goes_on() {
        let shown_faults: Vec<Option<Fault>> =
            ALL_FAULTS.into_iter().map(Some).chain([None]).collect();
        for first_fault in &shown_faults {
            for second_fault in shown_faults
                .iter()
                .filter(|second_fault| *second_fault != first_fault)
            {
                for frames in 1..300 {
                    let mut led = Led::default();
                    record_runs(&mut led, *first_fault, frames);
                    for frame in 0..400 {
                        let is_lit = led.advance(*second_fault);
                        assert_eq!(
                            is_lit,
                            should_be_lit(*second_fault, frame),
                            "{first_fault:?} {second_fault:?} {frames}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn another_fault_begins_its_pattern_at_once() {
        let mut led = Led::default();
        record_runs(&mut led, Some(Fault::Stack), 100);
        assert_eq!(
            record_runs(&mut led, Some(Fault::Guard), 10),
            [(true, 8), (false, 2)]
        );
        assert_eq!(record_runs(&mut led, None, 40), [(true, 32), (false, 8)]);
    }
}
