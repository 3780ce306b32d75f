//! Tests that the guard's limits are exact to the last bit.

use lizard_core::guard::clearance::Clearance;
use lizard_core::guard::hazard::Hazard;
use lizard_core::numbers::part::Side;
use lizard_core::numbers::units::Sine;
use lizard_host_tests::{NamedRobot, robots};
use lizard_robot::Robot;

use crate::reference::{MARGINS, steps_per_mm, to_sine};

/// Returns the limits of the ten margins from robot.toml.
fn margin_limits(robot: &Robot) -> [f64; 10] {
    let limits = robot.limits();
    std::array::from_fn(|index| match index {
        0..2 => limits.type2,
        2..6 => limits.type1,
        _ => limits.leg,
    })
}

/// Rounds a sine up to the next multiple of 2^-15, the core's step.
fn round_up_to_q15(limit: f64) -> i16 {
    (limit * 32768.0 - 1e-6).ceil() as i16
}

/// Returns a clearance with every margin exactly at its limit, and both sliders at their maximum length.
fn clearance_at_limit(robot: &Robot) -> Clearance {
    Clearance {
        margins: margin_limits(robot).map(|limit| Sine(round_up_to_q15(limit))),
        slider_lengths_sq: Side::ALL.map(|side| {
            let max = u32::from(robot.firmware().slider(side).stroke_max);
            max * max
        }),
    }
}

#[test]
fn a_margin_at_its_limit_is_safe_and_the_next_smaller_margin_is_a_hazard() {
    for NamedRobot { name, robot } in robots() {
        let firmware = robot.firmware();
        let hazard = clearance_at_limit(robot).first_hazard(firmware);
        assert_eq!(hazard, None, "{name}");
        for (index, margin) in MARGINS.into_iter().enumerate() {
            let mut clearance = clearance_at_limit(robot);
            let value = Sine(clearance.margins[index].0 - 1);
            clearance.margins[index] = value;
            let hazard = Some(Hazard::Margin { margin, value });
            assert_eq!(clearance.first_hazard(firmware), hazard, "{name}");
        }
    }
}

#[test]
fn a_slider_at_an_end_of_its_stroke_is_safe_and_the_next_length_beyond_is_a_hazard() {
    for NamedRobot { name, robot } in robots() {
        let firmware = robot.firmware();
        for (index, side) in Side::ALL.into_iter().enumerate() {
            let slider = firmware.slider(side);
            let [min_sq, max_sq] =
                [slider.stroke_min, slider.stroke_max].map(|steps| u32::from(steps).pow(2));
            for (length_sq, is_safe) in [
                (min_sq, true),
                (min_sq.wrapping_sub(1), false),
                (max_sq, true),
                (max_sq + 1, false),
            ] {
                let mut clearance = clearance_at_limit(robot);
                clearance.slider_lengths_sq[index] = length_sq;
                let reported_side = match clearance.first_hazard(firmware) {
                    None => None,
                    Some(Hazard::Stroke { side, .. }) => Some(side),
                    Some(hazard) => panic!("{name}: {hazard:?}"),
                };
                assert_eq!(
                    reported_side,
                    (!is_safe).then_some(side),
                    "{name}: squared length {length_sq}"
                );
            }
        }
    }
}

#[test]
fn the_guards_limits_match_the_robot_file_rounded_to_the_safe_side() {
    for NamedRobot { name, robot } in robots() {
        let core_limits = robot.firmware().limits();
        let file_limits = robot.limits();
        for (core_limit, file_limit) in [
            (core_limits.type2, file_limits.type2),
            (core_limits.type1, file_limits.type1),
            (core_limits.leg, file_limits.leg),
        ] {
            let next_smaller_limit = Sine(core_limit.0 - 1);
            assert!(
                to_sine(core_limit) >= file_limit - 1e-9
                    && to_sine(next_smaller_limit) < file_limit,
                "{name}: {core_limit:?} for {file_limit}"
            );
        }
        for (side, kinematics_side) in Side::ALL.into_iter().zip(lizard_kinematics::Side::ALL) {
            let slider = robot.firmware().slider(side);
            let nominal_mm = robot.lizard().side(kinematics_side).nominal_length;
            let length_mm = |steps: u16| f64::from(steps) / steps_per_mm(slider.scale);
            let [min_mm, max_mm] =
                [file_limits.stroke_min, file_limits.stroke_max].map(|stroke| nominal_mm + stroke);
            let (min, max) = (slider.stroke_min, slider.stroke_max);
            let is_min_exact = length_mm(min) >= min_mm - 1e-9 && length_mm(min - 1) < min_mm;
            assert!(is_min_exact, "{name}: {side:?}: shortest {min}");
            let is_max_exact = length_mm(max) <= max_mm + 1e-9 && length_mm(max + 1) > max_mm;
            assert!(is_max_exact, "{name}: {side:?}: longest {max}");
        }
    }
}
