//! The path of a routine's round, on the page's floor with the page's servos.

use lizard_robot::servo::FORWARD_TURN_SIGN;
use lizard_robot::{BodyPose, FRAMES_PER_SECOND, RoutineRow};
use lizard_twin::Twin;
use serde::Serialize;
use tsify::Tsify;

use crate::place::Place;

/// Largest number of frames of a path, two minutes: a routine may last for hours, and a step may wait forever.
const MAX_FRAMES: usize = 6_000;

/// Number of frames between two places of the path: a tenth of a second.
const FRAMES_PER_PLACE: usize = 5;

/// The path of a round that begins with a standing robot.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct RoundPath {
    /// Places in chronological order; the last place is the end of the path.
    pub places: Vec<Place>,
    /// Duration of the path, s.
    pub seconds: f64,
    /// True if the round continues beyond the path.
    pub is_truncated: bool,
}

impl RoundPath {
    /// Simulates one round of a routine with a twin's floor and servos; the twin's own place and pose do not change.
    /// `None` if there is no such routine.
    pub fn simulate(twin: &Twin, name: &str) -> Option<Self> {
        let robot = twin.robot();
        let mut simulated_twin = Twin::new(robot, twin.servo_model());
        simulated_twin.set_ground(*twin.ground());
        let neutral: [f64; 4] = robot.neutral_pose().into();
        let mut sweeps_by_frame = RoutineRow::simulate_sweeps(robot, robot.routine(name)?);
        let (mut places, mut frame_count, mut body_pose) = (Vec::new(), 0, BodyPose::START);
        for sweeps in sweeps_by_frame.by_ref().take(MAX_FRAMES) {
            if frame_count % FRAMES_PER_PLACE == 0 {
                places.push(body_pose.into());
            }
            frame_count += 1;
            let angles = std::array::from_fn(|i| neutral[i] + FORWARD_TURN_SIGN[i] * sweeps[i]);
            body_pose = simulated_twin.simulate_angles(angles).body_pose;
        }
        places.push(body_pose.into());
        Some(Self {
            places,
            seconds: frame_count as f64 / FRAMES_PER_SECOND,
            is_truncated: sweeps_by_frame.next().is_some(),
        })
    }
}

#[cfg(test)]
mod tests {
    use lizard_robot::Robot;
    use lizard_twin::ServoModel;

    use super::*;
    use crate::paper::PAPER_TOML;

    fn simulate_steps(steps: &str) -> RoundPath {
        let text = format!("{PAPER_TOML}\n[routine.one]\nsteps = [{steps}]\n");
        let robot = Robot::parse(&text).expect("the robot with the routine is valid");
        let twin = Twin::new(&robot, ServoModel::Ideal);
        RoundPath::simulate(&twin, "one").expect("the routine was added")
    }

    #[test]
    fn a_path_ends_at_the_sum_of_its_gaits_displacements() {
        let square = simulate_steps("\"walk 3\", \"left 6\", \"walk 3\"");
        let Some(Place { x, y, heading }) = square.places.last() else {
            panic!("the path has places")
        };
        // 34.17 mm and 15.34 deg per cycle; the transitions between the gaits move the robot by some mm, too.
        let turned_rad = (6.0_f64 * 15.34).to_radians();
        let walk_mm = 3.0 * 34.17;
        assert!((heading - 6.0 * 15.34).abs() < 3.0, "{heading} deg");
        let y_error = y - walk_mm * (1.0 + turned_rad.cos());
        assert!(y_error.abs() < 8.0, "y {y} mm");
        assert!((x + walk_mm * turned_rad.sin()).abs() < 8.0, "x {x} mm");
        let seconds = square.seconds;
        assert!((12.0..14.0).contains(&seconds), "{seconds} s");
        assert!(!square.is_truncated);
    }

    #[test]
    fn a_path_longer_than_two_minutes_is_truncated() {
        let long_path = simulate_steps("\"walk 2\", \"stand 999 s\"");
        assert!(long_path.is_truncated);
        assert_eq!(long_path.seconds, 120.0);
        let short_path = simulate_steps("\"walk 2\", \"stand 1 s\"");
        let end_y = |path: &RoundPath| path.places.last().expect("the path has places").y;
        assert!((end_y(&long_path) - end_y(&short_path)).abs() < 0.1);
    }
}
