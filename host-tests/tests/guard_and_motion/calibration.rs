//! Tests of each servo's numbers in the core (neutral angle, gain, travel and pin), and of the speed limit of a move.

use lizard_core::numbers::units::Sweep;
use lizard_host_tests::{NamedRobot, robots};

use crate::truth::to_degrees;

/// Steps of the core's angles in a degree.
const STEPS_PER_DEGREE: f64 = 65536.0 / 360.0;

#[test]
fn each_servo_has_the_neutral_angle_the_gain_and_the_pin_of_the_robot_file() {
    for NamedRobot { name, robot } in robots() {
        let firmware = robot.firmware();
        assert_eq!(
            firmware.pins(),
            robot.servos().map(|servo| servo.pin),
            "{name}"
        );
        for (n, servo) in robot.servos().iter().enumerate() {
            let calibration = firmware.calibration()[n];
            let neutral = to_degrees(firmware.neutral_angles()[n]);
            assert!(
                (neutral - servo.neutral % 360.0).abs() <= 0.5 / STEPS_PER_DEGREE,
                "{name}: A{}",
                n + 1
            );
            let mut pulse_count = 0;
            for sweep in (i16::MIN..=i16::MAX).step_by(17) {
                let exact_cycles = 16.0
                    * (servo.neutral_us
                        + servo.us_per_degree * f64::from(sweep) / STEPS_PER_DEGREE);
                if !(0.0..65536.0).contains(&exact_cycles) {
                    continue;
                }
                let error = f64::from(calibration.width(Sweep(sweep)).0) - exact_cycles;
                assert!(
                    error.abs() <= 2.0,
                    "{name}: A{} is {error} cycles off",
                    n + 1
                );
                pulse_count += 1;
            }
            // More than half of a turn has pulses.
            assert!(
                pulse_count > 65_536 / 17 / 2,
                "{name}: A{}: {pulse_count} pulses",
                n + 1
            );
        }
    }
}

#[test]
fn each_servos_travel_ends_at_the_last_step_within_its_range_of_pulses() {
    for NamedRobot { name, robot } in robots() {
        for (n, servo) in robot.servos().iter().enumerate() {
            let calibration = robot.firmware().calibration()[n];
            let pulse_us = |sweep: i32| {
                servo.neutral_us + servo.us_per_degree * f64::from(sweep) / STEPS_PER_DEGREE
            };
            let is_in_range = |sweep: i32| {
                let us = pulse_us(sweep);
                servo.min_us - 1e-6 <= us && us <= servo.max_us + 1e-6
            };
            for (end, outward_step) in [(calibration.travel_min, -1), (calibration.travel_max, 1)] {
                let end = i32::from(end.0);
                assert!(is_in_range(end), "{name}: A{} at {end}", n + 1);
                let next_sweep = end + outward_step;
                assert!(
                    !is_in_range(next_sweep) || next_sweep.abs() > 32_767,
                    "{name}: A{} at {next_sweep}",
                    n + 1
                );
            }
            assert!(
                calibration.reaches(calibration.travel_min)
                    && calibration.reaches(calibration.travel_max),
                "{name}"
            );
            let sweeps_beyond = [
                calibration.travel_min.0.checked_sub(1),
                calibration.travel_max.0.checked_add(1),
            ];
            for sweep in sweeps_beyond.into_iter().flatten() {
                assert!(
                    !calibration.reaches(Sweep(sweep)),
                    "{name}: A{} at {sweep}",
                    n + 1
                );
            }
        }
    }
}

#[test]
fn a_move_is_as_fast_as_the_file_allows_and_no_faster() {
    for NamedRobot { name, robot } in robots() {
        let speed = f64::from(robot.firmware().slew().per_frame) * 50.0 / STEPS_PER_DEGREE;
        let limit = robot.speed_limits().slew;
        assert!(
            speed <= limit + 1e-6 && speed > limit - 50.0 / STEPS_PER_DEGREE,
            "{name}"
        );
    }
}
