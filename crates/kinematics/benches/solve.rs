//! A benchmark of the forward kinematics: poses of a robot like the paper's per second on one core.

use std::hint::black_box;
use std::time::Instant;

use lizard_kinematics::{Leg, Lizard, Pose};

/// Number of poses in a pass.
const POSE_COUNT: usize = 200_000;

/// The lengths of the links, l0 to l19, mm: those of the paper's robot, except for the shorter chassis (l10, l15).
const LINKS: [f64; 20] = [
    20.0, 30.0, 50.0, 50.0, 30.0, 20.0, 30.0, 50.0, 50.0, 30.0, 100.0, 30.0, 45.0, 45.0, 30.0,
    100.0, 30.0, 45.0, 45.0, 30.0,
];

/// The neutral angles of the servos, degrees, in servo order.
const NEUTRAL_POSE: [f64; 4] = [138.59, 41.41, 318.59, 221.41];

/// Returns servo angles (degrees), each within 34 degrees of neutral. The multiples of irrational steps fill this range
/// evenly.
fn sample_pose(index: usize) -> [f64; 4] {
    let steps = [0.856_674_883, 0.733_891_856, 0.628_706_720, 0.538_597_257];
    std::array::from_fn(|servo| {
        NEUTRAL_POSE[servo] + 68.0 * (index as f64 * steps[servo]).fract() - 34.0
    })
}

fn main() {
    let leg = Leg {
        ground: 1.0,
        crank: 1.0,
        coupler: 1.0,
        follower: 1.0,
    };
    let lizard = Lizard {
        links: LINKS.into(),
        leg,
    };
    let poses: Vec<[f64; 4]> = (0..POSE_COUNT).map(sample_pose).collect();
    // The fastest of five passes over all poses.
    let pass_durations = (0..5).map(|_| {
        let start = Instant::now();
        for pose in &poses {
            let _ = black_box(lizard.solve(&Pose::from(*pose)));
        }
        start.elapsed().as_secs_f64()
    });
    let million_poses_per_second =
        POSE_COUNT as f64 / pass_durations.fold(f64::INFINITY, f64::min) / 1e6;
    println!("{million_poses_per_second:.2} million poses/s");
}
