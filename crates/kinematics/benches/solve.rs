//! Poses of the paper's robot solved per second on one core: one by one, and eight in step.

use std::hint::black_box;
use std::time::Instant;

use lizard_kinematics::{Lanes, Leg, Lizard, Pose};

const POSES: usize = 200_000;
const LANES: usize = 8;

/// The paper's links, l0 to l19, mm.
const LINKS: [f64; 20] = [
    20.0, 30.0, 50.0, 50.0, 30.0, 20.0, 30.0, 50.0, 50.0, 30.0, 100.0, 30.0, 45.0, 45.0, 30.0,
    100.0, 30.0, 45.0, 45.0, 30.0,
];

/// Neutral angles of the servos, degrees.
const NEUTRAL: [f64; 4] = [138.59, 41.41, 318.59, 221.41];

/// A pose within 34 degrees of neutral, the paper's safe box.
fn pose(number: usize) -> [f64; 4] {
    let steps = [0.856_674_883, 0.733_891_856, 0.628_706_720, 0.538_597_257];
    std::array::from_fn(|servo| {
        NEUTRAL[servo] + 68.0 * (number as f64 * steps[servo]).fract() - 34.0
    })
}

/// Prints the rate of the fastest of five passes over all poses.
fn measure(what: &str, mut pass: impl FnMut()) {
    let seconds = (0..5).map(|_| {
        let begin = Instant::now();
        pass();
        begin.elapsed().as_secs_f64()
    });
    let best = seconds.fold(f64::INFINITY, f64::min);
    println!(
        "{what:12} {:6.2} million poses/s",
        POSES as f64 / best / 1e6
    );
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
    let poses: Vec<[f64; 4]> = (0..POSES).map(pose).collect();
    measure("one by one", || {
        for pose in &poses {
            let _ = black_box(lizard.solve(&Pose::from(*pose)));
        }
    });
    measure("8 in step", || {
        for eight in poses.chunks_exact(LANES) {
            let lanes: [_; 4] = std::array::from_fn(|servo| {
                Lanes::<LANES>(std::array::from_fn(|i| eight[i][servo]))
            });
            let _ = black_box(lizard.solve_lanes(&Pose::from(lanes)));
        }
    });
}
