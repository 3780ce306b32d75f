//! The reasons for which a robot must not take a pose: violated limits, and angles outside the servos' travel.

use lizard_kinematics::{Pose, Solution, wrap};

use crate::config::servo;
use crate::robot::Robot;

/// Returns a message for each violation by a solved pose; none if the pose is safe.
pub fn find_pose_violations(robot: &Robot, solution: &Solution) -> Vec<String> {
    let limits = robot.limits().violations(solution);
    limits
        .map(|violation| violation.to_string())
        .chain(find_travel_violations(robot, &solution.pose))
        .collect()
}

/// Returns a message for each servo that cannot reach its angle in a pose.
pub fn find_travel_violations(robot: &Robot, pose: &Pose) -> impl Iterator<Item = String> {
    let angles = <[f64; 4]>::from(*pose);
    (0..4).filter_map(move |i| find_travel_violation(robot, i, angles[i]))
}

/// Returns a message if a servo (0 to 3) cannot reach an angle (deg, chassis frame), `None` if it can.
pub fn find_travel_violation(robot: &Robot, servo: usize, angle: f64) -> Option<String> {
    let servo_settings = &robot.servos()[servo];
    (!servo_settings.reaches(angle)).then(|| {
        let (neutral, (min, max)) = (servo_settings.neutral, servo_settings.travel());
        let sweep = wrap(angle - neutral);
        format!(
            "servo {} would turn {sweep:+.1} deg from neutral to {:.1} deg; its travel is {:.1} to {:.1} deg",
            servo::SERVO_NAMES[servo],
            neutral + sweep,
            neutral + min,
            neutral + max,
        )
    })
}
