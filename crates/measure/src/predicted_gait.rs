//! The predicted path of a gait.

use lizard_robot::{BodyPose, CheckedGait, FRAMES_PER_SECOND, Robot};
use lizard_twin::{ServoModel, Twin};
use lizard_video::Gait;

/// Predicts the path of a gait: simulates two cycles with the servos of robot.toml, and returns the second cycle.
/// `pace` is a multiple of the gait's nominal pace.
pub fn predict_gait(robot: &Robot, gait: &CheckedGait, pace: f64) -> Gait {
    let period = gait.period() / pace;
    let frames_per_cycle = (period * FRAMES_PER_SECOND).round().max(1.0) as usize;
    let mut twin = Twin::new(robot, ServoModel::for_robot(robot));
    let mut path = Vec::with_capacity(frames_per_cycle + 1);
    let mut start_pose = BodyPose::START;
    for frame in 0..=2 * frames_per_cycle {
        // The frames divide the cycle evenly, so that the path ends with the cycle.
        let seconds = frame as f64 / frames_per_cycle as f64 * gait.period();
        let phase = (gait.phase_at(seconds) * 65536.0).round() as i64;
        let angles = gait.table_angles(phase.rem_euclid(65536) as u16);
        let pose = twin.simulate_angles(angles).body_pose;
        if frame == frames_per_cycle {
            start_pose = pose;
        }
        if frame >= frames_per_cycle {
            let travel = pose.travel_from(start_pose);
            path.push(BodyPose::START.moved_by_travel(travel));
        }
    }
    Gait { period, path }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_path_is_one_cycle_long_even_if_the_cycle_is_not_a_whole_number_of_frames() {
        let robot = Robot::parse(include_str!("../../../robots/paper.toml"));
        let robot = robot.expect("paper.toml is valid");
        // In frames of 20 ms, 0.47 s are 23.5 and 0.48 s are 24.
        let [path, whole_path] = [0.47, 0.48].map(|period: f64| {
            let walk = "waveform = \"wave\"\nduty = 0.75\namplitude = 9.0\n\
                        start = { LH = 0.0, LF = 0.25, RH = 0.5, RF = 0.75 }";
            let robot = robot.with_gait(&format!("[gait.walk]\nperiod = {period}\n{walk}"));
            let robot = robot.expect("the gait is valid");
            let gait = robot.gait("walk").expect("the robot has the gait");
            predict_gait(&robot, gait, 1.0).path
        });
        assert_eq!(path, whole_path);
    }
}
