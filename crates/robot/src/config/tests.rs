//! Tests of the requirements for a robot's dimensions and for its servos' neutral pulses.

use crate::testing::{assert_contains, assert_starts_with, error_with};

#[test]
fn each_coupler_must_be_long_enough_for_its_own_loop() {
    // With these lengths, the scales of head and tail are 256 steps per mm.
    for (key, mm) in [("l2", 55), ("l3", 48), ("l7", 55), ("l8", 48)] {
        let (old, new) = (format!("{key} = {mm}.0"), format!("{key} = 15.9"));
        let message = error_with("unequal", &[(&old, &new)]);
        assert_contains(
            &message,
            &format!("links.{key} is 15.9 mm, which is too short"),
        );
        assert_contains(&message, "at least 16.1 mm");
    }
    // A longer base of the tail halves the steps per mm of the tail only.
    let changes = [("l5 = 30.0", "l5 = 90.0"), ("l7 = 55.0", "l7 = 31.0")];
    let message = error_with("unequal", &changes);
    assert_contains(&message, "links.l7 is 31 mm");
    assert_contains(&message, "at least 32.1 mm");
}

#[test]
fn a_neutral_pulse_outside_its_servos_range_is_rejected() {
    for (name, neutral_us, min_us, max_us) in [
        ("A1", "1470.0", 610.0, 2350.0),
        ("A2", "1535.0", 560.0, 2420.0),
        ("A3", "1500.0", 700.0, 2300.0),
        ("A4", "1440.0", 590.0, 2460.0),
    ] {
        let old_line = format!("neutral_us = {neutral_us}");
        for (rejected_us, rejected_key) in [
            (min_us - 0.1, "min_us"),
            (min_us, "min_us"),
            (max_us, "neutral_us"),
            (max_us + 0.1, "neutral_us"),
        ] {
            let new_line = format!("neutral_us = {rejected_us}");
            let message = error_with("unequal", &[(&old_line, &new_line)]);
            assert_contains(&message, &format!("servo.{name}.{rejected_key}"));
        }
    }
}

#[test]
fn a_stroke_that_exceeds_the_shorter_sliders_length_is_rejected() {
    for slider in [["l12 = 53.0", "l13 = 51.0"], ["l17 = 54.0", "l18 = 57.0"]] {
        let changes = [
            (slider[0], &*slider[0].replace(" 5", " 4")),
            ("stroke_min = -19.0", "stroke_min = -102.0"),
        ];
        let message = error_with("unequal", &changes);
        assert_contains(&message, "limits.stroke_min is -102; it must be between");
    }
}

#[test]
fn a_leg_in_its_other_assembly_mode_is_rejected() {
    for (old, new, name, leg) in [
        ("neutral = 135.0", "neutral = 200.0", "left front", "leg_lf"),
        ("neutral = 47.0", "neutral = 350.0", "right front", "leg_rf"),
        ("neutral = 316.0", "neutral = 10.0", "right hind", "leg_rh"),
        ("neutral = 228.0", "neutral = 170.0", "left hind", "leg_lh"),
    ] {
        let message = error_with("unequal", &[(old, new)]);
        let expected = format!("in the neutral pose the {name} leg would lock: margin {leg} -");
        assert_starts_with(&message, &expected);
    }
}
