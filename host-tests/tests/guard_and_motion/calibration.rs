//! Tests that each servo's calibration and pin in the core, and the speed limit of moves, match the robot file.

use lizard_core::numbers::units::Sweep;
use lizard_host_tests::{CYCLES_PER_US, NamedRobot, robots};
use lizard_robot::{FRAMES_PER_SECOND, STEPS_PER_DEGREE};

use crate::reference::{exact_width_us, to_degrees};

#[test]
fn neutral_angle_scale_and_pin_of_each_servo_match_the_robot_file() {
    for NamedRobot { name, robot } in robots() {
        let firmware = robot.firmware();
        let pins = robot.servos().map(|servo| servo.pin);
        assert_eq!(firmware.pins(), pins, "{name}");
        for (index, servo) in robot.servos().iter().enumerate() {
            let calibration = firmware.calibration()[index];
            let neutral_deg = to_degrees(firmware.neutral_angles()[index]);
            let error_deg = neutral_deg - servo.neutral % 360.0;
            let number = index + 1;
            assert!(
                error_deg.abs() <= 0.5 / STEPS_PER_DEGREE,
                "{name}: A{number}"
            );
            let mut pulse_count = 0;
            for sweep in (i16::MIN..=i16::MAX).step_by(17) {
                let exact_cycles = CYCLES_PER_US * exact_width_us(servo, sweep.into());
                if !(0.0..65536.0).contains(&exact_cycles) {
                    continue;
                }
                let error_cycles = f64::from(calibration.width(Sweep(sweep)).0) - exact_cycles;
                assert!(
                    error_cycles.abs() <= 2.0,
                    "{name}: A{number} is {error_cycles} cycles off"
                );
                pulse_count += 1;
            }
            // Most sweeps must give a representable pulse width, or the loop would check almost nothing.
            assert!(
                pulse_count > 65_536 / 17 / 2,
                "{name}: A{number}: {pulse_count} pulses"
            );
        }
    }
}

#[test]
fn each_servos_travel_ends_at_the_last_step_in_its_pulse_range() {
    for NamedRobot { name, robot } in robots() {
        for (index, servo) in robot.servos().iter().enumerate() {
            let calibration = robot.firmware().calibration()[index];
            let number = index + 1;
            let allowed_us = servo.min_us - 1e-6..=servo.max_us + 1e-6;
            let is_in_range = |sweep: i32| allowed_us.contains(&exact_width_us(servo, sweep));
            let reaches = |sweep: i32| {
                i16::try_from(sweep).is_ok_and(|sweep| calibration.reaches(Sweep(sweep)))
            };
            for (end, outward_step) in [(calibration.travel_min, -1), (calibration.travel_max, 1)] {
                let end = i32::from(end.0);
                let is_inside = is_in_range(end) && reaches(end);
                assert!(is_inside, "{name}: A{number} at {end}");
                let next_sweep = end + outward_step;
                let is_outside = !is_in_range(next_sweep) || next_sweep.abs() > 32_767;
                let is_outside = is_outside && !reaches(next_sweep);
                assert!(is_outside, "{name}: A{number} at {next_sweep}");
            }
        }
    }
}

#[test]
fn the_speed_limit_of_a_move_is_that_of_the_robot_file_rounded_down() {
    for NamedRobot { name, robot } in robots() {
        let step_speed = FRAMES_PER_SECOND / STEPS_PER_DEGREE;
        let max_speed = f64::from(robot.firmware().slew().per_frame) * step_speed;
        let limit = robot.speed_limits().slew;
        assert!(max_speed <= limit + 1e-6, "{name}");
        assert!(max_speed > limit - step_speed, "{name}");
    }
}
