//! The messages about a pose that a robot must not take: violated limits, and angles outside the servos' travel.

use lizard_kinematics::{Solution, wrap};

use crate::config::servo::SERVO_NAMES;
use crate::robot::Robot;

/// Returns a message for each limit or servo travel that a solved pose violates; the list is empty if the pose is
/// safe.
pub fn describe_pose_violations(robot: &Robot, solution: &Solution) -> Vec<String> {
    let limit_violations = robot.limits().violations(solution);
    let angles = <[f64; 4]>::from(solution.pose);
    let travel_violations = (0..4).filter_map(|i| describe_travel_violation(robot, i, angles[i]));
    limit_violations
        .map(|violation| violation.to_string())
        .chain(travel_violations)
        .collect()
}

/// Returns a message if a servo cannot reach an angle (deg, chassis frame); `None` if it can.
pub fn describe_travel_violation(robot: &Robot, servo_index: usize, angle: f64) -> Option<String> {
    let servo = &robot.servos()[servo_index];
    (!servo.reaches(angle)).then(|| {
        let neutral = servo.neutral;
        let (min, max) = servo.travel();
        let sweep = wrap(angle - neutral);
        format!(
            "servo {} would turn {sweep:+.1} deg from neutral to {:.1} deg; its travel is {:.1} to {:.1} deg",
            SERVO_NAMES[servo_index],
            neutral + sweep,
            neutral + min,
            neutral + max,
        )
    })
}
