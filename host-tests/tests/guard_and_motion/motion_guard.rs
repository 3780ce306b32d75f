//! Tests of the guard during motion: moves between two safe poses with an unsafe pose on the path, and running gaits.

use fastrand::Rng;
use lizard_core::guard::clearance::Clearance;
use lizard_core::guard::hazard::Hazard;
use lizard_core::motion::Activity;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::Sweep;
use lizard_host_tests::{NamedRobot, rng, robots};
use lizard_robot::{CoreRobot, Robot};

use crate::frames::{CheckedRobot, settling_frames};
use crate::truth::{Verdict, chassis_angles_deg, is_safe, random_pose_within};

/// Number of random pairs of poses tried for each robot. Some robots have no unsafe path between safe poses.
const TRY_COUNT: usize = 6000;
/// Maximum number of unsafe paths tested for each robot.
const MAX_PATH_COUNT: usize = 12;

/// Returns up to [`MAX_PATH_COUNT`] pairs of safe poses whose straight path is unsafe in floating point.
fn pairs_with_unsafe_path(rng: &mut Rng, robot: &Robot) -> Vec<[Pose; 2]> {
    let calibration = robot.firmware().calibration();
    let pose_near_limit = |rng: &mut Rng| {
        // Two cranks of a five-bar or of a side are near a limit; the other two are at neutral.
        let [first_servo, second_servo] = [[0, 1], [2, 3], [0, 3], [1, 2]][rng.usize(..4)];
        let random_pose = random_pose_within(rng, &calibration, 1.0);
        let mut pose = Pose::NEUTRAL;
        (pose.0[first_servo], pose.0[second_servo]) =
            (random_pose.0[first_servo], random_pose.0[second_servo]);
        let mut share_256 = 256;
        while !is_safe(robot.firmware(), &scale_pose(&pose, share_256)) {
            share_256 -= 4;
        }
        scale_pose(&pose, share_256)
    };
    let mut pairs = Vec::new();
    for _ in 0..TRY_COUNT {
        let (start_pose, end_pose) = (pose_near_limit(rng), pose_near_limit(rng));
        let [start_sweeps, end_sweeps] =
            [start_pose, end_pose].map(|pose| pose.0.map(|sweep| f64::from(sweep.0)));
        let is_unsafe_at = |step: u32| {
            let share = f64::from(step) / 50.0;
            let pose = Pose(std::array::from_fn(|servo| {
                let sweep = start_sweeps[servo] + share * (end_sweeps[servo] - start_sweeps[servo]);
                Sweep(sweep as i16)
            }));
            Verdict::of(robot, chassis_angles_deg(robot.firmware(), &pose)) == Verdict::Unsafe
        };
        if (1..50).step_by(4).any(is_unsafe_at) {
            pairs.push([start_pose, end_pose]);
        }
        if pairs.len() == MAX_PATH_COUNT {
            break;
        }
    }
    pairs
}

/// Returns a pose with every sweep multiplied by `share_256` / 256.
fn scale_pose(pose: &Pose, share_256: i32) -> Pose {
    Pose(
        pose.0
            .map(|sweep| Sweep((i32::from(sweep.0) * share_256 / 256) as i16)),
    )
}

#[test]
fn the_last_safe_pose_is_held_and_the_hazard_is_reported_once() {
    let mut held_count = 0;
    for (robot_index, named) in robots().iter().enumerate() {
        let NamedRobot { name, robot } = named;
        for [start_pose, end_pose] in
            pairs_with_unsafe_path(&mut rng(7000 + robot_index as u64), robot)
        {
            let mut walker = CheckedRobot::standing(named);
            // The command rounds the pose to hundredths of a degree, so the pose may be beyond a limit.
            if !walker
                .say(&walker.pose_command(&start_pose))
                .starts_with("ok")
            {
                continue;
            }
            walker.run_frames(settling_frames(robot));
            if walker.motion().hazard().is_some()
                || !walker
                    .say(&walker.pose_command(&end_pose))
                    .starts_with("ok")
            {
                continue;
            }
            let start_pose = walker.pose();
            // `run_frames` checks that every frame is safe.
            walker.run_frames(settling_frames(robot));
            // A fast move may cross a narrow unsafe region between two frames.
            let Some(hazard) = walker.motion().hazard() else {
                assert!(walker.pose().largest_turn_to(&end_pose) <= 1, "{name}");
                continue;
            };
            held_count += 1;
            assert_eq!(walker.motion().activity(), Activity::Stop, "{name}");
            let printed_lines = walker.take_output_lines();
            assert_eq!(printed_lines.len(), 1, "{name}: {printed_lines:?}");
            assert!(
                printed_lines[0].starts_with("# held in the last safe pose: "),
                "{printed_lines:?}"
            );
            // The reported hazard lies ahead on the path.
            assert!(
                violates_condition_ahead(
                    robot.firmware(),
                    start_pose,
                    end_pose,
                    walker.pose(),
                    hazard
                ),
                "{name}: {hazard:?}"
            );
            let held_pose = walker.pose();
            walker.run_frames(20);
            assert_eq!(walker.pose(), held_pose, "{name}");
            assert!(
                walker.take_output_lines().is_empty(),
                "{name}: the hazard is reported again"
            );
            assert!(walker.say("status").contains(" guard=held "), "{name}");
            // The robot can move back, unless the guard stops it again.
            assert!(
                walker.move_to(&start_pose) || walker.motion().hazard().is_some(),
                "{name}"
            );
            if walker.motion().hazard().is_none() {
                assert!(walker.say("status").contains(" guard=clear "), "{name}");
            }
        }
    }
    println!("the guard stopped {held_count} moves");
    assert!(held_count >= 10);
}

/// True if the rest of the path from the held pose violates the condition that a hazard names.
fn violates_condition_ahead(
    firmware: &CoreRobot,
    start_pose: Pose,
    end_pose: Pose,
    held_pose: Pose,
    hazard: Hazard,
) -> bool {
    let is_same_condition = |other_hazard: Hazard| match (hazard, other_hazard) {
        (Hazard::Margin { margin: a, .. }, Hazard::Margin { margin: b, .. }) => a == b,
        (Hazard::Stroke { side: a, .. }, Hazard::Stroke { side: b, .. }) => a == b,
        _ => false,
    };
    (0..=4000).any(|step| {
        let share = f64::from(step) / 4000.0;
        let pose = Pose(std::array::from_fn(|servo| {
            let [start, end] = [&start_pose, &end_pose].map(|pose| f64::from(pose.0[servo].0));
            Sweep((start + share * (end - start)).round() as i16)
        }));
        let is_ahead =
            held_pose.largest_turn_to(&start_pose) <= pose.largest_turn_to(&start_pose) + 1;
        is_ahead
            && Clearance::of(firmware, &pose)
                .first_hazard(firmware)
                .is_some_and(is_same_condition)
    })
}

#[test]
fn a_running_gait_is_never_stopped_by_the_guard() {
    let (mut walked_count, mut blocked_count) = (0, 0);
    for named in robots() {
        for gait in named.robot.gaits() {
            let mut walker = CheckedRobot::standing(named);
            walker.expect_ok(&gait.command());
            // The path to the gait's first pose may contain an unsafe pose.
            walker.run_frames(settling_frames(&named.robot));
            if walker.motion().hazard().is_some() {
                println!("{}: the path to {} is blocked", named.name, gait.name());
                blocked_count += 1;
                continue;
            }
            walked_count += 1;
            walker.run_frames((2.0 * gait.period() * 50.0) as u32);
            let hazard = walker.motion().hazard();
            assert!(
                hazard.is_none(),
                "{}: {}: {hazard:?}",
                named.name,
                gait.name()
            );
        }
    }
    assert!(
        walked_count > 10 * blocked_count,
        "{walked_count} gaits walked, {blocked_count} blocked"
    );
}
