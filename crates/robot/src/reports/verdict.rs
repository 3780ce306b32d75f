//! The reasons why a robot may not take a pose: its limits, and its servos' travel.

use lizard_kinematics::{Pose, Solution, wrap};

use crate::measures::servo;
use crate::robot::Robot;

/// Returns all reasons why the robot may not take a solved pose, each as a message; none if the pose is safe.
pub fn reasons(robot: &Robot, solution: &Solution) -> Vec<String> {
    let limits = robot.limits().violations(solution);
    limits
        .map(|violation| violation.to_string())
        .chain(out_of_travel(robot, &solution.pose))
        .collect()
}

/// Returns a message for each servo that cannot reach its angle in a pose.
pub fn out_of_travel(robot: &Robot, pose: &Pose) -> impl Iterator<Item = String> {
    let angles = <[f64; 4]>::from(*pose);
    (0..4).filter_map(move |i| beyond(robot, i, angles[i]))
}

/// Returns a message if a servo (0 to 3) cannot reach an angle (deg, chassis frame), `None` if it can.
pub fn beyond(robot: &Robot, servo: usize, angle: f64) -> Option<String> {
    let servo_numbers = &robot.servos()[servo];
    (!servo_numbers.reaches(angle)).then(|| {
        let (neutral, (min, max)) = (servo_numbers.neutral, servo_numbers.travel());
        let sweep = wrap(angle - neutral);
        format!(
            "servo {} would turn {sweep:+.1} deg from neutral to {:.1} deg, its travel is {:.1} to {:.1} deg",
            servo::NAMES[servo],
            neutral + sweep,
            neutral + min,
            neutral + max,
        )
    })
}
