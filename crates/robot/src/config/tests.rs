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
    for name in ["A1", "A2", "A3", "A4"] {
        let text = crate::testing::robot_text("unequal");
        let start = text.find(&format!("[servo.{name}]")).expect(name);
        let line_range = |key: &str| {
            let line_start = start + text[start..].find(key).expect(key);
            let line_end = line_start + text[line_start..].find('\n').expect("the line ends");
            line_start..line_end
        };
        let read_us = |key: &str| -> f64 {
            let line = &text[line_range(key)];
            let value = line.split(" = ").nth(1).expect("the line has a value");
            value.parse().expect("the value is a number")
        };
        for (neutral_us, rejected_key) in [
            (read_us("min_us") - 0.1, "min_us"),
            (read_us("min_us"), "min_us"),
            (read_us("max_us"), "neutral_us"),
            (read_us("max_us") + 0.1, "neutral_us"),
        ] {
            let line = format!("neutral_us = {neutral_us}");
            let mut changed = text.clone();
            changed.replace_range(line_range("neutral_us"), &line);
            let result = crate::Robot::parse(&changed);
            let error = result.expect_err("the neutral pulse is out of range");
            assert_contains(&error.to_string(), &format!("servo.{name}.{rejected_key}"));
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
