//! Tests of random commands with every robot: every frame is within the limits, and every command completes unless the
//! guard stops the robot.

use lizard_core::motion::Activity;
use lizard_host_tests::NamedRobot;

use crate::checked_robot::{
    CheckedRobot, final_activity, max_speed_change, random_command, settling_frames,
};
use crate::reference::robots_with_rngs;

/// Number of random dialogues with each robot in the first test; the second has three times as many.
const DIALOGUE_COUNT: u64 = 30;

#[test]
fn random_commands_make_no_frame_unsafe_too_fast_or_too_sudden() {
    for (named_robot, mut rng) in robots_with_rngs(1000) {
        let (mut accepted_count, mut refused_count, mut largest_change) = (0, 0, 0.0f64);
        for _ in 0..DIALOGUE_COUNT {
            let mut checked_robot = CheckedRobot::power_on(named_robot);
            for _ in 0..12 {
                let answer = checked_robot.say(&random_command(&mut rng, &named_robot.robot));
                match answer.starts_with("ok") {
                    true => accepted_count += 1,
                    false => refused_count += 1,
                }
                // Checks every frame.
                checked_robot.run_frames(rng.u32(..120));
            }
            largest_change = largest_change.max(checked_robot.largest_speed_change);
        }
        println!(
            "{}: {accepted_count} commands accepted, {refused_count} refused; \
             largest speed change {largest_change:.0} deg/s per frame, {:.0} allowed",
            named_robot.name,
            max_speed_change(&named_robot.robot)
        );
        assert!(
            accepted_count > 100 && refused_count > 0,
            "{}",
            named_robot.name
        );
    }
}

#[test]
fn every_command_completes_unless_the_guard_reports_a_hazard() {
    for (named_robot, mut rng) in robots_with_rngs(2000) {
        let NamedRobot { name, robot } = named_robot;
        let mut completed_count = 0;
        for _ in 0..3 * DIALOGUE_COUNT {
            let mut checked_robot = CheckedRobot::power_on(named_robot);
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
