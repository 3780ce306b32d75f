//! Poses of the paper's robot solved per second on one core.

use std::hint::black_box;
use std::time::Instant;

use lizard_kinematics::{Leg, Lizard, Pose};

const POSES: usize = 200_000;

/// The paper's links, l0 to l19, mm.
const LINKS: [f64; 20] = [
    20.0, 30.0, 50.0, 50.0, 30.0, 20.0, 30.0, 50.0, 50.0, 30.0, 100.0, 30.0, 45.0, 45.0, 30.0,
    100.0, 30.0, 45.0, 45.0, 30.0,
];

/// Neutral angles of the servos, degrees.
const NEUTRAL: [f64; 4] = [138.59, 41.41, 318.59, 221.41];

/// A pose within 34 degrees of neutral, the paper's safe box. Multiples of these irrational
/// steps fill the box evenly.
fn pose_of(number: usize) -> [f64; 4] {
    let steps = [0.856_674_883, 0.733_891_856, 0.628_706_720, 0.538_597_257];
    std::array::from_fn(|servo| {
        NEUTRAL[servo] + 68.0 * (number as f64 * steps[servo]).fract() - 34.0
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
    let poses: Vec<[f64; 4]> = (0..POSES).map(pose_of).collect();
    // The fastest of five passes over all poses.
    let seconds = (0..5).map(|_| {
        let start = Instant::now();
        for pose in &poses {
            let _ = black_box(lizard.solve(&Pose::from(*pose)));
        }
        start.elapsed().as_secs_f64()
    });
    let rate = POSES as f64 / seconds.fold(f64::INFINITY, f64::min) / 1e6;
    println!("one by one   {rate:6.2} million poses/s");
}
