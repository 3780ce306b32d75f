//! Tests of the transitions between all motions, for every robot. Every frame must be within the limits, and every
//! command must complete.

use lizard_core::motion::Activity;
use lizard_core::numbers::pose::Pose;
use lizard_host_tests::NamedRobot;

use crate::checked_robot::{
    CheckedRobot, WAKING_FRAMES, final_activity, gait_id, max_speed_change, random_command,
    settling_frames,
};
use crate::reference::{random_safe_pose, robots_with_rngs};

/// Number of random dialogues with each robot.
const DIALOGUE_COUNT: u64 = 30;

#[test]
fn no_command_sequence_makes_a_frame_unsafe_too_fast_or_too_sudden() {
    for (named, mut rng) in robots_with_rngs(1000) {
        let (mut accepted_count, mut refused_count, mut largest_change) = (0, 0, 0.0f64);
        for _ in 0..DIALOGUE_COUNT {
            let mut checked_robot = CheckedRobot::power_on(named);
            for _ in 0..12 {
                let answer = checked_robot.say(&random_command(&mut rng, &named.robot));
                match answer.starts_with("ok") {
                    true => accepted_count += 1,
                    false => refused_count += 1,
                }
                checked_robot.run_frames(rng.u32(..120));
            }
            largest_change = largest_change.max(checked_robot.largest_speed_change);
        }
        println!(
            "{}: {accepted_count} commands accepted, {refused_count} refused; \
             speed changes by at most {largest_change:.0} of {:.0} deg/s",
            named.name,
            max_speed_change(&named.robot)
        );
        assert!(accepted_count > 100 && refused_count > 0, "{}", named.name);
    }
}

#[test]
fn every_command_completes_unless_the_guard_reports_a_hazard() {
    for (named, mut rng) in robots_with_rngs(2000) {
        let NamedRobot { name, robot } = named;
        let mut completed_count = 0;
        for _ in 0..3 * DIALOGUE_COUNT {
            let mut checked_robot = CheckedRobot::power_on(named);
            for _ in 0..3 {
                checked_robot.say(&random_command(&mut rng, robot));
                checked_robot.run_frames(rng.u32(..60));
            }
            checked_robot.say("stand");
            let last_command = random_command(&mut rng, robot);
            let answer = checked_robot.say(&last_command);
            checked_robot.run_frames(2 * settling_frames(robot));
            let activity = checked_robot.motion().activity();
            if checked_robot.motion().hazard().is_some() {
                assert_eq!(activity, Activity::Stop, "{name}: {last_command}");
                continue;
            }
            match final_activity(robot, &last_command) {
                Some(expected) if answer.starts_with("ok") => {
                    assert_eq!(activity, expected, "{name}: {last_command}")
                }
                // After a `speed` command or a refused pose, the robot still stands or walks.
                _ => assert!(
                    matches!(activity, Activity::Gait(_)),
                    "{name}: {last_command}"
                ),
            }
            if let Activity::Gait(id) = activity {
                let firmware = robot.firmware();
                let phase = checked_robot.motion().phase();
                let pose = firmware.gait(id).pose(firmware.waves(), phase);
                assert_eq!(checked_robot.pose(), pose, "{name}: {last_command}");
            }
            completed_count += 1;
        }
        assert!(
            completed_count > DIALOGUE_COUNT,
            "{name}: only {completed_count} commands completed"
        );
    }
}

#[test]
fn a_refused_command_changes_nothing() {
    for (named, mut rng) in robots_with_rngs(3000) {
        let mut refused_count = 0;
        for _ in 0..DIALOGUE_COUNT {
            let [mut tested_robot, mut reference_robot] = [named; 2].map(CheckedRobot::power_on);
            for _ in 0..8 {
                let command = random_command(&mut rng, &named.robot);
                let frame_count = rng.u32(..60);
                if tested_robot.say(&command).starts_with("err") {
                    refused_count += 1;
                } else {
                    reference_robot.say(&command);
                }
                for _ in 0..frame_count {
                    let [tested, expected] = [&mut tested_robot, &mut reference_robot]
                        .map(|robot| (robot.run_frame(), robot.motion().activity()));
                    assert_eq!(tested, expected, "{}: {command}", named.name);
                }
            }
        }
        assert!(refused_count > 0, "{}", named.name);
    }
}

#[test]
fn in_a_move_all_servos_turn_by_the_same_fraction_and_arrive_together() {
    for (named, mut rng) in robots_with_rngs(4000) {
        let name = &named.name;
        let mut arrived_count = 0;
        for _ in 0..DIALOGUE_COUNT {
            let goal = random_safe_pose(&mut rng, named.robot.firmware());
            let mut checked_robot = CheckedRobot::power_on_and_stand(named);
            if !checked_robot.try_pose(&goal) {
                continue;
            }
            let mut poses = vec![checked_robot.pose()];
            while checked_robot.motion().activity() == Activity::Pose && poses.len() < 1000 {
                checked_robot.run_frames(1);
                poses.push(checked_robot.pose());
                if poses[poses.len() - 1] == poses[poses.len() - 2] && poses.len() > 30 {
                    break;
                }
            }
            if checked_robot.motion().hazard().is_some() {
                continue;
            }
            let end_pose = poses[poses.len() - 1];
            assert!(end_pose.max_turn_to(&goal) <= 1, "{name}");
            arrived_count += 1;
            let longest_turn = f64::from(Pose::NEUTRAL.max_turn_to(&end_pose));
            for pose in &poses {
                let fraction = 1.0 - f64::from(pose.max_turn_to(&end_pose)) / longest_turn;
                for (sweep, end_sweep) in pose.0.iter().zip(&end_pose.0) {
                    let error = f64::from(sweep.0) - fraction * f64::from(end_sweep.0);
                    assert!(error.abs() <= 4.0, "{name}: {pose:?} to {end_pose:?}");
                }
            }
        }
        assert!(arrived_count > 0, "{name}: no move arrived");
    }
}

#[test]
fn servos_wake_one_by_one_in_the_pose_before_the_rest() {
    for (named, mut rng) in robots_with_rngs(5000) {
        let calibration = named.robot.firmware().calibration();
        let mut checked_robot = CheckedRobot::power_on(named);
        let safe_pose = random_safe_pose(&mut rng, named.robot.firmware());
        for pose_before_rest in [Pose::NEUTRAL, safe_pose] {
            if pose_before_rest != Pose::NEUTRAL {
                checked_robot.try_pose(&pose_before_rest);
                checked_robot.settle();
                checked_robot.expect_ok("rest");
                checked_robot.run_frames(10);
                checked_robot.expect_ok("stand");
            }
            let held_pose = checked_robot.pose();
            let mut first_pulse_frames = [0; 4];
            for frame in 1..=WAKING_FRAMES {
                for (servo, width) in checked_robot.run_frame().0.into_iter().enumerate() {
                    if width.0 > 0 && first_pulse_frames[servo] == 0 {
                        first_pulse_frames[servo] = frame;
                    }
                    let expected_width = calibration[servo].width(held_pose.0[servo]);
                    assert!(width.0 == 0 || width == expected_width, "{}", named.name);
                    let has_woken = first_pulse_frames[servo] > 0;
                    assert_eq!(width.0 > 0, has_woken, "a servo fell asleep again");
                }
            }
            // The servos wake a tenth of a second apart.
            assert_eq!(first_pulse_frames, [5, 10, 15, 20], "{}", named.name);
            checked_robot.settle();
        }
    }
}

#[test]
fn stop_freezes_and_rest_silences_the_next_frame_and_the_gait_can_restart() {
    for (named, mut rng) in robots_with_rngs(6000) {
        let robot = &named.robot;
        for _ in 0..DIALOGUE_COUNT {
            let mut checked_robot = CheckedRobot::power_on_and_stand(named);
            let gait = &robot.gaits()[rng.usize(..robot.gaits().len())];
            checked_robot.expect_ok(&gait.command());
            checked_robot.run_frames(rng.u32(..200));
            let last_gait_pose = checked_robot.pose();
            let command = ["stop", "rest"][rng.usize(..2)];
            checked_robot.expect_ok(command);
            for _ in 0..5 {
                let is_silent = checked_robot.run_frame().0.iter().all(|width| width.0 == 0);
                assert_eq!(is_silent, command == "rest", "{}", named.name);
                assert_eq!(checked_robot.pose(), last_gait_pose, "{}", named.name);
                assert_eq!(checked_robot.motion().phase(), 0, "{}", named.name);
            }
            checked_robot.expect_ok("stand");
            checked_robot.expect_ok(&gait.command());
            let firmware = robot.firmware();
            let first_pose = firmware.gait(gait_id(gait)).pose(firmware.waves(), 0);
            let has_begun = (0..2 * settling_frames(robot)).any(|_| {
                checked_robot.run_frames(1);
                checked_robot.motion().phase() == 0 && checked_robot.pose() == first_pose
            });
            assert!(has_begun, "{}: {}", named.name, gait.name());
        }
    }
}
