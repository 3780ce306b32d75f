//! Random poses of the paper's robot, which are the same on every run.

use std::f64::consts::PI;

use lizard_kinematics::{Leg, Links, Lizard, Pose, Solution, Vector};

/// The paper's table of link lengths as printed: the numbers of links and their length, mm. It lists l16 twice, and
/// does not list l17.
pub const LINK_TABLE: [(&[usize], f64); 5] = [
    (&[0, 5], 20.0),
    (&[1, 4, 6, 9, 14, 11, 16, 19], 30.0),
    (&[2, 3, 7, 8], 50.0),
    (&[12, 13, 16, 18], 45.0),
    (&[10, 15], 135.0),
];

/// Creates the paper's robot. The second l16 of the paper's table is taken as l17.
pub fn paper_lizard() -> Lizard {
    let mut lengths = [0.0; 20];
    for (links, length) in LINK_TABLE {
        for &i in links {
            lengths[if i == 16 && length == 45.0 { 17 } else { i }] = length;
        }
    }
    Lizard {
        links: Links::from(lengths),
        leg: Leg {
            ground: 50.0,
            crank: 45.0,
            coupler: 50.0,
            follower: 45.0,
        },
    }
}

/// A pose with its solution, and two random numbers for equations that do not depend on a pose.
pub struct Sample {
    /// The robot of all samples.
    pub lizard: Lizard,
    /// The pose's solution by lizard-kinematics, without the paper's equations.
    pub solution: Solution,
    /// Two random numbers, uniform in [0, 1).
    pub random: [f64; 2],
}

impl Sample {
    /// Generates `count` samples whose cranks point outward and away from the chassis: theta1 and -theta5 in [90, 180)
    /// deg, theta4 and -theta8 in [0, 90) deg. Poses without a solution are skipped.
    pub fn generate(count: usize) -> impl Iterator<Item = Self> {
        let lizard = paper_lizard();
        let mut generator = Random(1);
        std::iter::repeat_with(move || {
            let mut draw_angle_above = |min: f64| min + 90.0 * generator.next();
            let pose = Pose {
                theta1: draw_angle_above(90.0),
                theta4: draw_angle_above(0.0),
                theta8: 360.0 - draw_angle_above(0.0),
                theta5: 360.0 - draw_angle_above(90.0),
            };
            let random = [generator.next(), generator.next()];
            let solution = lizard.solve(&pose).ok()?;
            Some(Self {
                lizard,
                solution,
                random,
            })
        })
        .flatten()
        .take(count)
    }

    /// The paper's angles theta1 to theta16, in radians, counter-clockwise in the chassis frame; index 0 is unused.
    pub fn theta(&self) -> [f64; 17] {
        let pose = &self.solution.pose;
        let mut theta = [0.0; 17];
        theta[1] = pose.theta1;
        theta[2] = self.solution.theta2();
        theta[3] = self.solution.theta3();
        theta[4] = pose.theta4;
        theta[5] = pose.theta5;
        theta[6] = self.solution.theta6();
        theta[7] = self.solution.theta7();
        theta[8] = pose.theta8;
        theta[9] = pose.theta5 - 90.0;
        theta[10] = self.solution.left.phi();
        theta[11] = theta[10] + 180.0;
        theta[12] = pose.theta1 + 90.0;
        theta[13] = pose.theta8 + 90.0;
        theta[14] = self.solution.right.phi();
        theta[15] = theta[14] + 180.0;
        theta[16] = pose.theta4 - 90.0;
        theta.map(|degrees| degrees * PI / 180.0)
    }
}

/// Creates the vector with this length and this angle in radians.
pub fn polar(length: f64, radians: f64) -> Vector {
    Vector::new(length * radians.cos(), length * radians.sin())
}

/// Computes the difference between two angles in radians, in degrees from 0 to 180.
pub fn angle_error_deg(a: f64, b: f64) -> f64 {
    lizard_kinematics::wrap((a - b) * 180.0 / PI).abs()
}

/// Solves a t^2 + b t + c = 0 for t = tan(x / 2) and returns the angle x (rad). `root_sign` selects the root.
/// `None` if the roots are not real. A radicand of zero may be slightly negative from rounding.
pub fn solve_half_angle(a: f64, b: f64, c: f64, root_sign: f64) -> Option<f64> {
    let radicand = b * b - 4.0 * a * c;
    let tangent = (-b + root_sign * radicand.max(0.0).sqrt()) / (2.0 * a);
    (radicand > -1e-12).then(|| 2.0 * tangent.atan())
}

/// A SplitMix64 generator, whose numbers, and therefore the table of errata, are the same on every run and host.
struct Random(u64);

impl Random {
    /// Returns the next number, uniform in [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
