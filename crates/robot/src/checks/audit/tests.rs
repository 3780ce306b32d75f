//! Tests of the audit with gaits at their limits and just beyond their limits.

use crate::robot::STAND;
use crate::testing::{
    assert_contains, assert_starts_with, error_with, for_each_gait, robot, robot_with,
    text_before_gaits, valid_robot_with,
};
use crate::{CheckedGait, Robot};
use lizard_core::guard::hazard::{Hazard, Margin};
use lizard_core::numbers::part::{End, Servo, Side as CoreSide};
use lizard_core::numbers::units::Sine;
use lizard_kinematics::{Check, Side};

/// Computes each slider's smallest and largest stroke over a gait, mm.
fn compute_stroke_ranges(robot: &Robot, gait: &CheckedGait) -> [(f64, f64); 2] {
    let mut ranges = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    for phase in (0..=u16::MAX).step_by(32) {
        let solution = robot.lizard().solve(&gait.table_angles(phase).into());
        let solution = solution.expect("a checked gait closes its loops");
        for ((min, max), side) in ranges.iter_mut().zip(Side::ALL) {
            let stroke = solution.side(side).s;
            (*min, *max) = (min.min(stroke), max.max(stroke));
        }
    }
    ranges
}

/// Parses the robot `unequal`, modified so that its sliders have their nominal lengths in the neutral pose, and with
/// these replacements of limits. Its only moving gait, `lean`, moves the legs of one side, so that only this side's
/// slider moves.
fn parse_leaning_robot(side: Side, limits: &[(&str, String)]) -> Result<Robot, crate::Error> {
    let gain = match side {
        Side::Left => "RF = 0.0, RH = 0.0",
        Side::Right => "LF = 0.0, LH = 0.0",
    };
    let mut text = text_before_gaits("unequal")
        .replacen("l13 = 51.0", "l13 = 57.0", 1)
        .replacen("l18 = 57.0", "l18 = 51.4", 1);
    for (old, new) in limits {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    Robot::parse(&format!(
        "{text}{STAND}[gait.lean]\nperiod = 2.0\nwaveform = \"wave\"\nduty = 0.75\namplitude = 17.0\nstart = {{ LH = 0.0, LF = 0.25, RH = 0.5, RF = 0.75 }}\ngain = {{ {gain} }}\n"
    ))
}

#[test]
fn the_stroke_range_covers_both_sliders() {
    for side in Side::ALL {
        let robot = parse_leaning_robot(side, &[]).expect("the leaning robot is valid");
        let gait = robot.gait("lean").expect("the robot has the gait lean");
        let (expected_min, expected_max) = compute_stroke_ranges(&robot, gait)[side as usize];
        let (min_stroke, max_stroke) = gait.audit().stroke_range;
        let strokes = format!("strokes of {expected_min} to {expected_max} mm");
        assert!(expected_min < -5.0 && expected_max > 3.0, "{strokes}");
        for (stroke, expected) in [(min_stroke, expected_min), (max_stroke, expected_max)] {
            assert!((stroke - expected).abs() < 0.05, "{stroke} mm, {strokes}");
        }
    }
}

#[test]
fn the_message_names_the_slider_that_hits_its_end_stop() {
    for side in Side::ALL {
        let robot = parse_leaning_robot(side, &[]).expect("the leaning robot is valid");
        let gait = robot.gait("lean").expect("the robot has the gait lean");
        let (min_stroke, max_stroke) = compute_stroke_ranges(&robot, gait)[side as usize];
        let min_limit = |mm: f64| ("stroke_min = -19.0", format!("stroke_min = {mm:.2}"));
        let max_limit = |mm: f64| ("stroke_max = 41.0", format!("stroke_max = {mm:.2}"));
        for (limit, word) in [
            (min_limit(min_stroke + 0.5), "below"),
            (max_limit(max_stroke - 0.5), "above"),
        ] {
            let message = parse_leaning_robot(side, &[limit])
                .expect_err("the stroke is too small for the gait")
                .to_string();
            let expected_start = format!(
                "in \"lean\" the {side} slider would hit its end stop: {side} slider travel "
            );
            assert_starts_with(&message, &expected_start);
            assert!(message.ends_with(": gait.lean)"), "{message}");
            assert_contains(&message, word);
        }
        let wide_limits = [min_limit(min_stroke - 0.2), max_limit(max_stroke + 0.2)];
        assert!(parse_leaning_robot(side, &wide_limits).is_ok());
    }
}

#[test]
fn each_hazard_corresponds_to_the_check_of_the_same_condition() {
    let margin_hazard = |margin| Hazard::Margin {
        margin,
        value: Sine(0),
    };
    let stroke_hazard = |side| Hazard::Stroke { side, length: 0 };
    for (hazard, name) in [
        (margin_hazard(Margin::Type2(End::Head)), "type2_head"),
        (margin_hazard(Margin::Type2(End::Tail)), "type2_tail"),
        (margin_hazard(Margin::Type1(Servo::A2)), "type1_a2"),
        (margin_hazard(Margin::Type1(Servo::A4)), "type1_a4"),
        (margin_hazard(Margin::Leg(Servo::A1)), "leg_lf"),
        (margin_hazard(Margin::Leg(Servo::A3)), "leg_rh"),
        (stroke_hazard(CoreSide::Left), "stroke_left"),
        (stroke_hazard(CoreSide::Right), "stroke_right"),
    ] {
        assert_eq!(super::check_of_hazard(&hazard).name(), name);
    }
}

#[test]
fn every_sample_of_every_servo_is_checked() {
    for_each_gait(|label, _, gait| {
        let phases = super::list_phases(gait.table_gait());
        for channel in gait.table_gait().channels {
            for sample in (0..=u16::MAX).step_by(1024) {
                let phase = sample.wrapping_sub(channel.offset);
                assert!(phases.contains(&phase), "{label}: phase {phase} is missing");
            }
        }
    });
}

#[test]
fn a_backward_swing_has_the_same_peak_speed_as_a_forward_swing() {
    // All legs have a negative gain, so they swing backward.
    let table = "[gait.backward]\nlike = \"walk\"\ngain = { LF = -1.0, RF = -1.0, RH = -1.0, LH = -1.0 }\n[gait.trot]";
    let robot = valid_robot_with("unequal", &[("[gait.trot]", table)]);
    let peak_speed = |name: &str| robot.gait(name).expect(name).audit().peak_speed.speed;
    assert!((peak_speed("backward") - peak_speed("walk")).abs() < 1e-9);
}

#[test]
fn a_gait_may_be_as_fast_as_the_limit_but_no_faster() {
    let unequal = robot("unequal");
    let peak_speed = |gait: &CheckedGait| gait.audit().peak_speed.speed;
    let max_speed = unequal.gaits().iter().map(peak_speed).fold(0.0, f64::max);
    let robot_with_limit = |speed: f64| {
        let limit_line = format!("gait_slew = {speed:?}");
        robot_with("unequal", &[("gait_slew = 330.0", &limit_line)])
    };
    assert!(robot_with_limit(max_speed).is_ok());
    let error = robot_with_limit(max_speed - 1e-6).expect_err("the gait is too fast");
    assert_contains(&error.to_string(), "limits.gait_slew is");
}

#[test]
fn a_gait_may_use_the_whole_travel_but_no_more() {
    // A held leg swings exactly its amplitude to either side of neutral.
    let robot_with_travel = |degrees: f64| {
        let servo_keys = format!("us_per_degree = 8.5\nmin_us = {:?}", 1500.0 - degrees * 8.5);
        let old_keys = "us_per_degree = 8.5\nmin_us = 700.0";
        let body = text_before_gaits("unequal").replacen(old_keys, &servo_keys, 1);
        Robot::parse(&format!(
            "{body}{STAND}[gait.sway]\nperiod = 2.0\nwaveform = \"held\"\namplitude = 17.0\norder = [\"LH\", \"LF\", \"RH\", \"RF\"]\n"
        ))
    };
    let gait_count = robot_with_travel(17.0).map(|robot| robot.gaits().len());
    assert_eq!(gait_count, Ok(2));
    let error = robot_with_travel(16.9).expect_err("the travel is a tenth of a degree too small");
    let consequence = "in \"sway\" servo A3 would have to turn farther than it can: ";
    assert_starts_with(&error.to_string(), consequence);
    assert_contains(&error.to_string(), " is outside its travel of 299.10 to");
}

#[test]
fn both_ends_of_every_servos_travel_are_checked() {
    // The robot cannot walk if a servo has only about a degree of travel on one side.
    for (servo, min_line, max_line, neutral) in [
        ("A1", "min_us = 610.0", "max_us = 2350.0", 1470.0),
        ("A2", "min_us = 560.0", "max_us = 2420.0", 1535.0),
        ("A3", "min_us = 700.0", "max_us = 2300.0", 1500.0),
        ("A4", "min_us = 590.0", "max_us = 2460.0", 1440.0),
    ] {
        for (old, new) in [
            (min_line, format!("min_us = {}", neutral - 9.0)),
            (max_line, format!("max_us = {}", neutral + 9.0)),
        ] {
            let message = error_with("unequal", &[(old, &new)]);
            let expected = format!("in \"walk\" servo {servo} would have to turn farther");
            assert_starts_with(&message, &expected);
        }
    }
}

#[test]
fn each_kind_of_margin_is_checked_against_its_own_limit() {
    let unequal = robot("unequal");
    for (line, checks) in [
        ("type2 = 0.32 ", &Check::TYPE2[..]),
        ("type1 = 0.27 ", &Check::TYPE1),
        ("leg = 0.38 ", &Check::LEG),
    ] {
        let name = line.split(' ').next().expect("the text begins with a key");
        let min_margin_of = |gait: &CheckedGait| {
            let audit = gait.audit();
            let margins = [audit.type2, audit.type1, audit.leg].into_iter();
            let margins = margins.filter(|margin| checks.contains(&margin.check));
            let [min_margin] = margins.collect::<Vec<_>>()[..] else {
                panic!("{audit:?}")
            };
            min_margin.value
        };
        let min_margins = unequal.gaits().iter().map(min_margin_of);
        let min_margin = min_margins.fold(1.0, f64::min);
        let robot_with_limit =
            |value: f64| robot_with("unequal", &[(line, &format!("{name} = {value:?} "))]);
        // The firmware's guard is accurate to one or two thousandths.
        assert!(robot_with_limit(min_margin - 0.003).is_ok(), "{name}");
        let error = robot_with_limit(min_margin + 1e-6).expect_err(name);
        assert_contains(&error.to_string(), &format!("margin {name}_"));
    }
}

#[test]
fn a_gait_is_rejected_even_if_only_the_firmwares_guard_rejects_it() {
    // If the limit is only slightly below the gaits' smallest margin, by at most three units of the firmware's
    // integers, the floating-point check still accepts every gait, but the guard of at least one robot rejects a gait.
    let mut messages = Vec::new();
    for (name, line) in [
        ("paper", "leg = 0.3 "),
        ("unequal", "leg = 0.38 "),
        ("large", "type1 = 0.3 "),
        ("unequal", "type1 = 0.27 "),
    ] {
        let robot = robot(name);
        let min_margin_of = |gait: &CheckedGait| match line.starts_with("leg") {
            true => gait.audit().leg.value,
            false => gait.audit().type1.value,
        };
        let min_margin = robot.gaits().iter().map(min_margin_of).fold(1.0, f64::min);
        let limit_name = line.split(' ').next().expect("the text begins with a key");
        for i in 1..10 {
            let limit_line = format!("{limit_name} = {:?} ", min_margin - f64::from(i) * 1e-5);
            let error = robot_with(name, &[(line, &limit_line)]).err();
            messages.extend(error.map(|error| error.to_string()));
        }
    }
    let has_messages = !messages.is_empty();
    assert!(has_messages, "no limit was rejected by the guard alone");
    for message in messages {
        assert_contains(&message, ": margin or travel ");
        assert_contains(&message, "place it beyond the limit; leave more room (");
    }
}

#[test]
fn each_smallest_margin_occurs_at_its_reported_phase() {
    for_each_gait(|label, robot, gait| {
        let audit = gait.audit();
        for min_margin in [audit.type2, audit.type1, audit.leg] {
            let phase = (min_margin.phase * 65536.0) as u16;
            let solution = robot.lizard().solve(&gait.table_angles(phase).into());
            let solution = solution.expect("a checked gait closes its loops");
            let mut conditions = solution.conditions();
            let condition = conditions.find(|(check, _)| *check == min_margin.check);
            let (_, value) = condition.expect("the solution has this condition");
            assert_eq!(value, min_margin.value, "{label}");
        }
    });
}
