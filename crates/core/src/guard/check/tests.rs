//! Intact sections that would harm a servo or the board: one wrong number at a time, each
//! next to the nearest harmless one.

use std::vec::Vec;

use super::*;
use crate::numbers::calibration::Reach;
use crate::numbers::section::seal;
use crate::sample::Sample;

/// A section of the odd robot with changed numbers.
struct ChangedSection(Vec<u8>);

impl ChangedSection {
    fn new() -> Self {
        Self(Sample::odd().content.section())
    }

    fn put(mut self, offset: u16, word: u16) -> Self {
        self.0[usize::from(offset)..][..2].copy_from_slice(&word.to_le_bytes());
        self
    }

    fn put_byte(mut self, offset: u16, byte: u8) -> Self {
        self.0[usize::from(offset)] = byte;
        self
    }

    /// True if the guard accepts the section.
    fn is_accepted(&self) -> bool {
        let mut section = self.0.clone();
        seal(&mut section);
        match Robot::open(Region::new(&section)) {
            Ok(_) => true,
            Err(damage) => {
                assert_eq!(damage, Damage::Impossible);
                false
            }
        }
    }
}

/// True if the odd robot's section still opens with this word at that offset.
fn is_accepted_with(offset: u16, word: u16) -> bool {
    ChangedSection::new().put(offset, word).is_accepted()
}

#[test]
fn a_pin_is_free_used_once_and_not_the_rails() {
    // D0 and D1 are the serial line, D13 is the LED.
    let is_free = |pin: u8| (2..=12).contains(&pin) || (14..=19).contains(&pin);
    let other_pins_of = |servo: u16| {
        let pins = Sample::odd().content.pins;
        (0..4)
            .filter(move |index| *index != usize::from(servo))
            .map(move |index| pins[index])
    };
    for rail in [0, 14, 19] {
        for servo in 0..4 {
            for pin in 0..=u8::MAX {
                let section = ChangedSection::new().put(offset!(rail), rail);
                let is_accepted = section.put_byte(offset!(pins) + servo, pin).is_accepted();
                let is_used = other_pins_of(servo)
                    .chain([rail as u8])
                    .any(|other_pin| other_pin == pin);
                let is_rail_unused =
                    other_pins_of(servo).all(|other_pin| u16::from(other_pin) != rail);
                let expected = is_free(pin) && !is_used && is_rail_unused;
                assert_eq!(
                    is_accepted,
                    expected,
                    "A{} on {pin}, the rail on {rail}",
                    servo + 1
                );
            }
        }
    }
    let pins = Sample::odd().content.pins;
    for rail in 0..=u8::MAX {
        let is_valid_rail = (14..=19).contains(&rail) && !pins.contains(&rail);
        assert_eq!(
            is_accepted_with(offset!(rail), rail.into()),
            rail == 0 || is_valid_rail,
            "{rail}"
        );
    }
}

#[test]
fn a_servo_tolerates_the_pulses_of_its_travel_and_gaits_stay_within_it() {
    for servo in 0..4 {
        let is_accepted_with_change = |change: &dyn Fn(&mut Calibration)| {
            let mut content = Sample::odd().content.clone();
            let calibration = &mut content.calibration[servo];
            calibration.gain = 11_395;
            (calibration.min, calibration.max) = (Sweep(-9_000), Sweep(9_000));
            change(calibration);
            ChangedSection(content.section()).is_accepted()
        };
        assert!(is_accepted_with_change(&|_| {}));
        for min_pulse in [7_999, 8_000] {
            // The shortest pulse is that of the travel's clockwise limit.
            let move_to_end = |calibration: &mut Calibration| {
                let pulse_below_neutral =
                    calibration.neutral.0 - calibration.pulse(calibration.min);
                calibration.neutral.0 = min_pulse + pulse_below_neutral;
            };
            assert!(is_accepted_with_change(&move_to_end), "{servo} {min_pulse}");
        }
        let shorten_too_far = |calibration: &mut Calibration| {
            let pulse_below_neutral = calibration.neutral.0 - calibration.pulse(calibration.min);
            calibration.neutral.0 = 7_998 + pulse_below_neutral;
        };
        assert!(!is_accepted_with_change(&shorten_too_far), "{servo}");
        for (max_pulse, is_tolerated) in [(40_001, true), (40_002, false)] {
            let move_to_end = |calibration: &mut Calibration| {
                let pulse_above_neutral =
                    calibration.pulse(calibration.max) - calibration.neutral.0;
                calibration.neutral.0 = max_pulse - pulse_above_neutral;
            };
            assert_eq!(
                is_accepted_with_change(&move_to_end),
                is_tolerated,
                "{servo} {max_pulse}"
            );
        }
        // The neutral angle is within the travel, even if no gait needs it.
        for (travel, has_neutral) in [([0, 900], true), ([1, 900], false), ([-900, -1], false)] {
            let mut content = Sample::odd().content.clone();
            let [min, max] = travel.map(Sweep);
            let calibration = &mut content.calibration[servo];
            (calibration.min, calibration.max) = (min, max);
            content.reach[servo] = Reach { min, max };
            assert_eq!(
                ChangedSection(content.section()).is_accepted(),
                has_neutral,
                "{travel:?}"
            );
        }
        let reach = Sample::odd().content.reach[servo];
        for (excess, is_within) in [(0, true), (1, false)] {
            assert_eq!(
                is_accepted_with_change(&|calibration| calibration.min.0 = reach.min.0 + excess),
                is_within
            );
            assert_eq!(
                is_accepted_with_change(&|calibration| calibration.max.0 = reach.max.0 - excess),
                is_within
            );
        }
    }
}

#[test]
fn the_guard_accepts_the_neutral_pose() {
    for change in 0..3 {
        let mut content = Sample::odd().content.clone();
        assert!(ChangedSection(content.section()).is_accepted());
        match change {
            0 => content.limits.leg.0 = i16::MAX,
            1 => content.limits.type1.0 = i16::MAX,
            _ => content.limits.type2.0 = i16::MAX,
        }
        assert!(!ChangedSection(content.section()).is_accepted(), "{change}");
    }
}
