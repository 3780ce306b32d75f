//! Tests of sections with a correct CRC that would damage a servo or the board. Each test changes one number, and also
//! checks the nearest harmless value.

use super::*;
use crate::numbers::calibration::SweepRange;
use crate::numbers::section::Content;
use crate::sample::Sample;

/// True if [`Robot::open`] accepts the section of [`Sample::asymmetric`] after this change.
fn is_accepted_after(change: impl FnOnce(&mut Content)) -> bool {
    let mut content = Sample::asymmetric().content;
    change(&mut content);
    match Robot::open(Region::new(&content.section_bytes())) {
        Ok(_) => true,
        Err(error) => {
            assert_eq!(error, SectionError::Harmful);
            false
        }
    }
}

#[test]
fn each_servo_and_the_rail_require_a_usable_pin_of_their_own() {
    // D0 and D1 are the serial port, D13 is the LED.
    let is_usable_pin = |pin: u8| (2..=12).contains(&pin) || (14..=19).contains(&pin);
    let pins = Sample::asymmetric().content.pins;
    for rail_pin in [0, 14, 19] {
        for servo in 0..4 {
            // The pins of the other servos, and in place of this servo's pin that of the rail.
            let mut other_pins = pins;
            other_pins[servo] = rail_pin;
            for pin in 0..=u8::MAX {
                let is_accepted = is_accepted_after(|content| {
                    content.rail_pin = Some(rail_pin);
                    content.pins[servo] = pin;
                });
                let is_valid_pin = is_usable_pin(pin) && !other_pins.contains(&pin);
                let case = (servo, pin, rail_pin);
                assert_eq!(is_accepted, is_valid_pin, "{case:?}");
            }
        }
    }
    for rail_pin in 0..=u8::MAX {
        let is_valid_rail = (14..=19).contains(&rail_pin) && !pins.contains(&rail_pin);
        let is_accepted = is_accepted_after(|content| content.rail_pin = Some(rail_pin));
        assert_eq!(is_accepted, rail_pin == 0 || is_valid_rail, "{rail_pin}");
    }
}

#[test]
fn a_travel_must_cover_the_gaits_and_the_neutral_angle_with_tolerable_pulses() {
    for servo in 0..4 {
        let is_accepted_with_change = |change: &dyn Fn(&mut Calibration)| {
            is_accepted_after(|content| {
                let calibration = &mut content.calibration[servo];
                calibration.gain = 11_395;
                (calibration.travel_min, calibration.travel_max) = (Sweep(-9_000), Sweep(9_000));
                change(calibration);
            })
        };
        assert!(is_accepted_with_change(&|_| {}));
        // The shortest pulse belongs to the travel's clockwise limit, the longest pulse to the other limit.
        for (limit, pulse, is_tolerated) in [
            (Sweep(-9_000), 7_998, false),
            (Sweep(-9_000), 7_999, true),
            (Sweep(-9_000), 8_000, true),
            (Sweep(9_000), 40_001, true),
            (Sweep(9_000), 40_002, false),
        ] {
            let is_accepted = is_accepted_with_change(&|calibration| {
                let width = calibration.clamped_width(limit);
                calibration.neutral_width.0 = pulse + calibration.neutral_width.0 - width;
            });
            assert_eq!(is_accepted, is_tolerated, "servo {servo}: {pulse} cycles");
        }
        // The travel must include the neutral angle even if the gaits do not need it.
        for (travel, has_neutral) in [([0, 900], true), ([1, 900], false), ([-900, -1], false)] {
            let [min, max] = travel.map(Sweep);
            let is_accepted = is_accepted_after(|content| {
                let calibration = &mut content.calibration[servo];
                (calibration.travel_min, calibration.travel_max) = (min, max);
                content.needed_travel[servo] = SweepRange { min, max };
            });
            assert_eq!(is_accepted, has_neutral, "{travel:?}");
        }
        let needed_travel = Sample::asymmetric().content.needed_travel[servo];
        for (excess, is_within) in [(0, true), (1, false)] {
            let changes: [&dyn Fn(&mut Calibration); 2] = [
                &|calibration| calibration.travel_min.0 = needed_travel.min.0 + excess,
                &|calibration| calibration.travel_max.0 = needed_travel.max.0 - excess,
            ];
            assert_eq!(changes.map(is_accepted_with_change), [is_within; 2]);
        }
    }
}

#[test]
fn a_section_whose_neutral_pose_is_unsafe_is_refused() {
    assert!(is_accepted_after(|_| {}));
    let changes: [fn(&mut Content); 3] = [
        |content| content.limits.leg.0 = i16::MAX,
        |content| content.limits.type1.0 = i16::MAX,
        |content| content.limits.type2.0 = i16::MAX,
    ];
    assert_eq!(changes.map(is_accepted_after), [false; 3]);
}
