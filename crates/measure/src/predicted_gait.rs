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
        let seconds = frame as f64 / FRAMES_PER_SECOND * pace;
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
