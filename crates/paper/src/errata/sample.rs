//! Random poses of the paper's robot, the same ones on every run.

use std::f64::consts::PI;

use lizard_kinematics::{Leg, Links, Lizard, Pose, Solution, Vector};

/// The paper's table of link lengths as printed, mm: it names l16 twice and l17 never.
pub const TABLE: [(&[usize], f64); 5] = [
    (&[0, 5], 20.0),
    (&[1, 4, 6, 9, 14, 11, 16, 19], 30.0),
    (&[2, 3, 7, 8], 50.0),
    (&[12, 13, 16, 18], 45.0),
    (&[10, 15], 135.0),
];

/// The paper's robot, with the second l16 of its table taken as l17.
pub fn paper_lizard() -> Lizard {
    let mut lengths = [0.0; 20];
    for (links, length) in TABLE {
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
    /// The geometric solution.
    pub s: Solution,
    /// Uniform in [0, 1).
    pub random: [f64; 2],
}

/// All angles of the paper, in radians, counter-clockwise in the chassis frame.
pub struct Angles {
    /// theta1 to theta16; index 0 is unused.
    pub t: [f64; 17],
}

impl Sample {
    /// `count` poses whose cranks point outward and away from the chassis: theta1 and -theta5 in [90, 180],
    /// theta4 and -theta8 in [0, 90]. Poses without a solution are skipped.
    pub fn many(count: usize) -> impl Iterator<Item = Self> {
        let lizard = paper_lizard();
        let mut random = Random(1);
        std::iter::repeat_with(move || {
            let mut angle_from = |min: f64| min + 90.0 * random.next();
            let pose = Pose {
                theta1: angle_from(90.0),
                theta4: angle_from(0.0),
                theta8: 360.0 - angle_from(0.0),
                theta5: 360.0 - angle_from(90.0),
            };
            let random = [random.next(), random.next()];
            let solution = lizard.solve(&pose).ok()?;
            Some(Self {
                lizard,
                s: solution,
                random,
            })
        })
        .flatten()
        .take(count)
    }

    /// Computes the paper's angles theta1 to theta16.
    pub fn angles(&self) -> Angles {
        let pose = &self.s.pose;
        let mut t = [0.0; 17];
        t[1] = pose.theta1;
        t[2] = self.s.theta2();
        t[3] = self.s.theta3();
        t[4] = pose.theta4;
        t[5] = pose.theta5;
        t[6] = self.s.theta6();
        t[7] = self.s.theta7();
        t[8] = pose.theta8;
        t[9] = pose.theta5 - 90.0;
        t[10] = self.s.left.phi();
        t[11] = t[10] + 180.0;
        t[12] = pose.theta1 + 90.0;
        t[13] = pose.theta8 + 90.0;
        t[14] = self.s.right.phi();
        t[15] = t[14] + 180.0;
        t[16] = pose.theta4 - 90.0;
        Angles {
            t: t.map(|degrees| degrees * PI / 180.0),
        }
    }
}

/// The vector with this length and this angle in radians.
pub fn cis(length: f64, radians: f64) -> Vector {
    Vector::new(length * radians.cos(), length * radians.sin())
}

/// The difference of two angles in radians, in degrees from 0 to 180.
pub fn angle_error(a: f64, b: f64) -> f64 {
    lizard_kinematics::wrap((a - b) * 180.0 / PI).abs()
}

/// A SplitMix64 generator: the table of errata must be the same on every run and every host.
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
