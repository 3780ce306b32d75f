//! Tests of running gaits: the duration of their cycles at full and other speeds, and the poses of their frames.

use lizard_core::numbers::units::CYCLE;
use lizard_host_tests::{NamedRobot, rng, robots};

use crate::checked_robot::{CheckedRobot, check_running_gaits, gait_id};
use crate::gaits::{FULL_PACE, all_gaits};

#[test]
fn a_hundred_cycles_take_a_hundred_periods() {
    for (NamedRobot { name, .. }, float_gait, gait) in all_gaits() {
        let frame_count = (5000.0 * float_gait.period()).round();
        let phase = (0..frame_count as u32).fold(0, |phase, _| gait.advance(phase, FULL_PACE));
        // A frame's phase advance is rounded to 1/2^24 cycle, so each frame adds an error of up to half a step.
        let expected_phase = (frame_count / 50.0 / float_gait.period()).fract();
        let sign = if float_gait.is_reversed() { -1.0 } else { 1.0 };
        let difference =
            (f64::from(phase) / f64::from(CYCLE) - sign * expected_phase).rem_euclid(1.0);
        let error = difference.min(1.0 - difference) * f64::from(CYCLE);
        assert!(
            error <= 0.5 * frame_count + 1.0,
            "{name}: {} is off by {error} phase steps of 1/2^24 cycle",
            float_gait.name()
        );
    }
}

#[test]
fn every_speed_sets_its_percentage_of_a_gaits_full_pace() {
    const FRAME_COUNT: u32 = 1000;
    let mut rng = rng(8000);
    let mut worst_error = 0.0f64;
    check_running_gaits(1, |named_robot, float_gait, checked_robot| {
        for percent in [10, 100, rng.u8(11..100)] {
            checked_robot.expect_ok(&format!("speed {percent}"));
            checked_robot.run_frames(10);
            let mut advance = 0i64;
            for _ in 0..FRAME_COUNT {
                let previous_phase = checked_robot.motion().phase();
                checked_robot.run_frames(1);
                // A frame advances by less than half a cycle, so the wrapped difference has the correct sign.
                let phase_step = checked_robot.motion().phase().wrapping_sub(previous_phase) << 8;
                advance += i64::from(phase_step as i32 >> 8);
            }
            let cycles = advance as f64 / f64::from(CYCLE);
            let sign = if float_gait.is_reversed() { -1.0 } else { 1.0 };
            let fraction = sign * f64::from(percent) / 100.0;
            let error =
                cycles / (fraction * f64::from(FRAME_COUNT) / 50.0 / float_gait.period()) - 1.0;
            worst_error = worst_error.max(error.abs());
            assert!(
                error.abs() <= 0.005,
                "{} {} at {percent} %: relative error {error}",
                named_robot.name,
                float_gait.name()
            );
        }
    });
    println!("the pace is off by at most {:.2} %", 100.0 * worst_error);
}

#[test]
fn a_gait_that_is_commanded_again_continues() {
    for named_robot in robots() {
        for gait in named_robot.robot.gaits() {
            let mut tested = CheckedRobot::power_on_and_stand(named_robot);
            let mut reference = CheckedRobot::power_on_and_stand(named_robot);
            for frame in 0..150 {
                if frame % 7 == 0 {
                    tested.expect_ok(&gait.command());
                }
                if frame == 0 {
                    reference.expect_ok(&gait.command());
                }
                let (pulses, expected) = (tested.run_frame(), reference.run_frame());
                assert_eq!(pulses, expected, "{}: {}", named_robot.name, gait.name());
            }
        }
    }
}

#[test]
fn every_frame_of_a_running_gait_is_a_pose_of_the_gait_and_the_guard_never_stops_it() {
    check_running_gaits(0, |NamedRobot { name, robot }, gait, checked_robot| {
        let firmware = robot.firmware();
        let core_gait = firmware.gait(gait_id(gait));
        let frame_count = (2.0 * gait.period() * 50.0).max(100.0) as u32;
        for _ in 0..frame_count {
            checked_robot.run_frames(1);
            let hazard = checked_robot.motion().hazard();
            assert_eq!(hazard, None, "{name}: {}", gait.name());
            let phase = checked_robot.motion().phase();
            let expected = core_gait.pose(firmware.waves(), phase);
            assert_eq!(checked_robot.pose(), expected, "{name}");
        }
    });
}
