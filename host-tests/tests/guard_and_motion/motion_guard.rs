//! Test of the guard during moves between two safe poses with an unsafe pose on the path.

use fastrand::Rng;
use lizard_core::guard::clearance::Clearance;
use lizard_core::guard::hazard::Hazard;
use lizard_core::motion::Activity;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::Sweep;
use lizard_host_tests::NamedRobot;
use lizard_robot::{CoreRobot, Robot};

use crate::checked_robot::CheckedRobot;
use crate::reference::{is_clearly_unsafe, is_safe, random_pose, robots_with_rngs};

/// Number of random pairs of poses that are tried for each robot. Some robots have no unsafe path between safe poses.
const ATTEMPT_COUNT: usize = 6000;
/// Maximum number of unsafe paths that are tested for each robot.
const MAX_PATH_COUNT: usize = 12;

/// Finds up to [`MAX_PATH_COUNT`] pairs of safe poses whose straight path is unsafe in floating point.
fn find_pairs_with_unsafe_path(rng: &mut Rng, robot: &Robot) -> Vec<[Pose; 2]> {
    let calibration = robot.firmware().calibration();
    let pose_near_limit = |rng: &mut Rng| {
        // Two cranks of a five-bar or a side are near a limit; the other two are neutral.
        let [first_servo, second_servo] = [[0, 1], [2, 3], [0, 3], [1, 2]][rng.usize(..4)];
        let random_pose = random_pose(rng, &calibration);
        let mut pose = Pose::NEUTRAL;
        (pose.0[first_servo], pose.0[second_servo]) =
            (random_pose.0[first_servo], random_pose.0[second_servo]);
        let mut fraction_256 = 256;
        while !is_safe(robot.firmware(), &scale_pose(&pose, fraction_256)) {
            fraction_256 -= 4;
        }
        scale_pose(&pose, fraction_256)
    };
    let mut pairs = Vec::new();
    for _ in 0..ATTEMPT_COUNT {
        let (start_pose, end_pose) = (pose_near_limit(rng), pose_near_limit(rng));
        let is_unsafe_at = |step: u32| {
            let sweeps = interpolate(&start_pose, &end_pose, f64::from(step) / 50.0);
            is_clearly_unsafe(robot, &Pose(sweeps.map(|sweep| Sweep(sweep as i16))))
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

/// Returns the sweeps at a fraction of the straight path between two poses, in steps of the core.
fn interpolate(start_pose: &Pose, end_pose: &Pose, fraction: f64) -> [f64; 4] {
    std::array::from_fn(|servo| {
        let [start, end] = [start_pose, end_pose].map(|pose| f64::from(pose.0[servo].0));
        start + fraction * (end - start)
    })
}

/// Returns a pose with every sweep multiplied by `fraction_256` / 256.
fn scale_pose(pose: &Pose, fraction_256: i32) -> Pose {
    let scale = |sweep: Sweep| Sweep((i32::from(sweep.0) * fraction_256 / 256) as i16);
    Pose(pose.0.map(scale))
}

#[test]
fn the_last_safe_pose_is_held_and_the_hazard_is_reported_once() {
    let mut held_count = 0;
    for (named_robot, mut rng) in robots_with_rngs(7000) {
        let NamedRobot { name, robot } = named_robot;
        for [start_pose, end_pose] in find_pairs_with_unsafe_path(&mut rng, robot) {
            let mut checked_robot = CheckedRobot::power_on_and_stand(named_robot);
            let is_at_start = checked_robot.try_pose(&start_pose) && checked_robot.settle();
            if !is_at_start || !checked_robot.try_pose(&end_pose) {
                continue;
            }
            // Rounding to hundredths of a degree may move the commanded pose by a step.
            assert!(checked_robot.pose().max_turn_to(&start_pose) <= 1, "{name}");
            let start_pose = checked_robot.pose();
            // `settle` checks that every frame is safe.
            checked_robot.settle();
            // A fast move may cross a narrow unsafe region between two frames.
            let Some(hazard) = checked_robot.motion().hazard() else {
                assert!(checked_robot.pose().max_turn_to(&end_pose) <= 1, "{name}");
                continue;
            };
            held_count += 1;
            assert_eq!(checked_robot.motion().activity(), Activity::Stop, "{name}");
            let printed_lines = checked_robot.take_output_lines();
            assert_eq!(printed_lines.len(), 1, "{name}: {printed_lines:?}");
            assert!(
                printed_lines[0].starts_with("# held in the last safe pose: "),
                "{printed_lines:?}"
            );
            // The reported hazard lies ahead on the path.
            let (firmware, held_pose) = (robot.firmware(), checked_robot.pose());
            let is_ahead =
                violates_condition_ahead(firmware, start_pose, end_pose, held_pose, hazard);
            assert!(is_ahead, "{name}: {hazard:?}");
            checked_robot.run_frames(20);
            assert_eq!(checked_robot.pose(), held_pose, "{name}");
            let new_lines = checked_robot.take_output_lines();
            let is_quiet = new_lines.is_empty();
            assert!(is_quiet, "{name}: the hazard was reported again");
            let status = checked_robot.say("status");
            assert!(status.contains(" guard=held "), "{name}");
            // The robot can move back, unless the guard stops it again.
            let is_accepted = checked_robot.try_pose(&start_pose);
            assert!(is_accepted, "{name}: {start_pose:?}");
            if checked_robot.settle() {
                let status = checked_robot.say("status");
                assert!(status.contains(" guard=clear "), "{name}");
            }
        }
    }
    println!("the guard stopped {held_count} moves");
    assert!(held_count >= 10);
}

/// True if the remaining path from the held pose violates the condition that the hazard names.
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
        let sweeps = interpolate(&start_pose, &end_pose, f64::from(step) / 4000.0);
        let pose = Pose(sweeps.map(|sweep| Sweep(sweep.round() as i16)));
        let is_ahead = held_pose.max_turn_to(&start_pose) <= pose.max_turn_to(&start_pose) + 1;
        is_ahead
            && Clearance::measure(firmware, &pose)
                .first_hazard(firmware)
                .is_some_and(is_same_condition)
    })
}
