//! Section 5: K, K* and the singularity conditions.

use std::f64::consts::{FRAC_PI_2, PI};

use lizard_kinematics::End;

use super::equation::{Aside, Equation};
use super::sample::Sample;

/// In the paper's order.
pub const EQUATIONS: &[Equation] = &[
    Equation {
        place: "5.1 shape of K",
        printed: "K is 8x8, its determinant must not vanish",
        miss: |s| Some(8.0 - s.s.active_matrix()[0].len() as f64),
        unit: "columns more than servos",
        aside: None,
        clockwise: None,
        corrected: Some(("K is 8x4: four active rates, no determinant", |s| {
            Some(4.0 - s.s.active_matrix()[0].len() as f64)
        })),
    },
    Equation {
        place: "5.1 K, head",
        printed: "[-l1 sin θ1, -l4 sin θ4; l1 cos θ1, -l4 cos θ4]",
        miss: |s| Some(against(&k(s, 0, 0, 1), &k_head(s, s.angles().t[4]))),
        unit: "mm/rad",
        aside: None,
        // d/dθ4 changes sign with the sense of θ4.
        clockwise: Some(|s| {
            let mut truth = k(s, 0, 0, 1);
            truth[1] = -truth[1];
            truth[3] = -truth[3];
            Some(against(&truth, &k_head(s, PI - s.angles().t[4])))
        }),
        corrected: Some(("second column +l4 sin θ4, -l4 cos θ4", |s| {
            let (l, t) = (&s.lizard.links, s.angles().t);
            let block = [
                -l.l1 * t[1].sin(),
                l.l4 * t[4].sin(),
                l.l1 * t[1].cos(),
                -l.l4 * t[4].cos(),
            ];
            Some(against(&k(s, 0, 0, 1), &block))
        })),
    },
    Equation {
        place: "5.1 K, tail",
        printed: "[-l6 sin θ5, -l9 sin θ8; l6 cos θ5, -l9 cos θ8]",
        miss: |s| Some(against(&k(s, 2, 3, 2), &k_tail(s, s.angles().t[8]))),
        unit: "mm/rad",
        aside: None,
        clockwise: Some(|s| {
            let mut truth = k(s, 2, 3, 2);
            truth[1] = -truth[1];
            truth[3] = -truth[3];
            Some(against(&truth, &k_tail(s, PI - s.angles().t[8])))
        }),
        corrected: Some(("second column +l9 sin θ8, -l9 cos θ8", |s| {
            let (l, t) = (&s.lizard.links, s.angles().t);
            let block = [
                -l.l6 * t[5].sin(),
                l.l9 * t[8].sin(),
                l.l6 * t[5].cos(),
                -l.l9 * t[8].cos(),
            ];
            Some(against(&k(s, 2, 3, 2), &block))
        })),
    },
    Equation {
        place: "5.1 K, left",
        printed: "[l11 sin(C3 - θ5), -l14 sin(C1 + θ1); l11 cos(C3 - θ5), -l14 cos(C1 + θ1)]",
        miss: |s| {
            let (l, t) = (&s.lizard.links, s.angles().t);
            let block = side([l.l11, l.l14], FRAC_PI_2 - t[5], FRAC_PI_2 + t[1], -1.0);
            Some(against(&k(s, 4, 3, 0).map(|v| -v), &block))
        },
        unit: "mm/rad",
        aside: None,
        clockwise: None,
        corrected: Some(("+l14 sin(C1 + θ1)", |s| {
            let (l, t) = (&s.lizard.links, s.angles().t);
            let block = side([l.l11, l.l14], FRAC_PI_2 - t[5], FRAC_PI_2 + t[1], 1.0);
            Some(against(&k(s, 4, 3, 0).map(|v| -v), &block))
        })),
    },
    Equation {
        place: "5.1 K, right",
        printed: "[l16 sin(C4 - θ8), -l19 sin(C2 + θ4); l16 cos(C4 - θ8), -l19 cos(C2 + θ4)]",
        miss: |s| {
            let (l, t) = (&s.lizard.links, s.angles().t);
            let block = side([l.l16, l.l19], FRAC_PI_2 - t[8], FRAC_PI_2 + t[4], -1.0);
            Some(against(&k(s, 6, 2, 1).map(|v| -v), &block))
        },
        unit: "mm/rad",
        aside: None,
        clockwise: None,
        corrected: Some(("+l19 sin(C2 + θ4), and C2 = C4 = -90°", |s| {
            let (l, t) = (&s.lizard.links, s.angles().t);
            let block = side([l.l16, l.l19], -FRAC_PI_2 - t[8], -FRAC_PI_2 + t[4], 1.0);
            Some(against(&k(s, 6, 2, 1).map(|v| -v), &block))
        })),
    },
    Equation {
        place: "5.1 K*, head",
        printed: "[-l2 sin θ2, -l3 sin θ3; l2 cos θ2, -l3 cos θ3]",
        miss: |s| {
            Some(against(
                &passive(s, 0),
                &k_star(s, HEAD, s.angles().t[3], -1.0),
            ))
        },
        unit: "mm/rad",
        aside: None,
        clockwise: Some(|s| {
            let mut truth = passive(s, 0);
            truth[1] = -truth[1];
            truth[3] = -truth[3];
            Some(against(
                &truth,
                &k_star(s, HEAD, PI - s.angles().t[3], -1.0),
            ))
        }),
        corrected: Some(("second column +l3 sin θ3, -l3 cos θ3", |s| {
            Some(against(
                &passive(s, 0),
                &k_star(s, HEAD, s.angles().t[3], 1.0),
            ))
        })),
    },
    Equation {
        place: "5.1 K*, tail",
        printed: "[-l7 sin θ6, -l8 sin θ7; l7 cos θ6, -l8 cos θ7]",
        miss: |s| {
            Some(against(
                &passive(s, 2),
                &k_star(s, TAIL, s.angles().t[7], -1.0),
            ))
        },
        unit: "mm/rad",
        aside: None,
        clockwise: Some(|s| {
            let mut truth = passive(s, 2);
            truth[1] = -truth[1];
            truth[3] = -truth[3];
            Some(against(
                &truth,
                &k_star(s, TAIL, PI - s.angles().t[7], -1.0),
            ))
        }),
        corrected: Some(("second column +l8 sin θ7, -l8 cos θ7", |s| {
            Some(against(
                &passive(s, 2),
                &k_star(s, TAIL, s.angles().t[7], 1.0),
            ))
        })),
    },
    Equation {
        place: "5.1 determinant of the printed K*",
        printed: "l2 l3 l7 l8 l12 l13 l17 l18 sin 2θ11 sin 2θ14 (cos(θ2+θ3-θ6-θ7) - cos(θ2+θ3+θ6+θ7))/2",
        miss: |s| {
            let t = s.angles().t;
            let product = (t[2] + t[3]).sin() * (t[6] + t[7]).sin();
            let printed =
                ((t[2] + t[3] - t[6] - t[7]).cos() - (t[2] + t[3] + t[6] + t[7]).cos()) / 2.0;
            Some((product - printed).abs())
        },
        unit: "per product of lengths; it follows from the printed matrix",
        aside: None,
        clockwise: None,
        corrected: None,
    },
    Equation {
        place: "5.1 singular head",
        printed: "sin(θ2 + θ3) = 0",
        miss: |s| {
            let t = s.angles().t;
            Some(((t[2] + t[3]).sin().abs() - s.s.margins.type2[0]).abs())
        },
        unit: "in the sine",
        aside: Some(Aside {
            place: "the neutral pose, which it flags",
            miss: |s| {
                let (home, sum) = neutral(s)?;
                Some((sum.sin().abs() - home).abs())
            },
        }),
        clockwise: Some(|s| {
            let t = s.angles().t;
            Some(((t[2] + PI - t[3]).sin().abs() - s.s.margins.type2[0]).abs())
        }),
        corrected: Some(("sin(θ3 - θ2) = 0", |s| {
            let t = s.angles().t;
            Some(((t[3] - t[2]).sin() - determinant_sine(&passive(s, 0), 2500.0)).abs())
        })),
    },
    Equation {
        place: "5.1 singular tail",
        printed: "sin(θ6 + θ7) = 0",
        miss: |s| {
            let t = s.angles().t;
            Some(((t[6] + t[7]).sin().abs() - s.s.margins.type2[1]).abs())
        },
        unit: "in the sine",
        aside: None,
        clockwise: Some(|s| {
            let t = s.angles().t;
            Some(((t[6] + PI - t[7]).sin().abs() - s.s.margins.type2[1]).abs())
        }),
        corrected: Some(("sin(θ7 - θ6) = 0", |s| {
            let t = s.angles().t;
            Some(((t[7] - t[6]).sin() - determinant_sine(&passive(s, 2), 2500.0)).abs())
        })),
    },
    Equation {
        place: "5.1 singular left side",
        printed: "sin 2θ11 = 0",
        miss: |s| Some(1.0 - (2.0 * s.angles().t[11]).sin().abs()),
        unit: "in the sine, of a block that is never singular",
        aside: None,
        clockwise: None,
        corrected: Some(("never: the block's determinant is -d", |s| {
            let [a, b, c, d] = passive(s, 4);
            Some((a * d - b * c + s.s.left.d).abs())
        })),
    },
    Equation {
        place: "5.1 singular right side",
        printed: "sin 2θ14 = 0",
        miss: |s| Some(1.0 - (2.0 * s.angles().t[14]).sin().abs()),
        unit: "in the sine, of a block that is never singular",
        aside: None,
        clockwise: None,
        corrected: Some(("never: the block's determinant is -d", |s| {
            let [a, b, c, d] = passive(s, 6);
            Some((a * d - b * c + s.s.right.d).abs())
        })),
    },
    Equation {
        place: "5.2 shape of the leg's K",
        printed: "K is 2x2 and holds θ_lg12, which is passive",
        miss: |s| Some(2.0 - mobility_of_leg(s)),
        unit: "columns more than drives",
        aside: None,
        clockwise: None,
        corrected: Some(("K is 2x1: [-lg1 sin θ_lg1; lg1 cos θ_lg1]", |s| {
            Some(1.0 - mobility_of_leg(s))
        })),
    },
    Equation {
        place: "5.2 singular leg",
        printed: "-lg12 lg13 sin(θ_lg1 + θ_lg12 - θ_lg13) = 0",
        miss: |s| {
            let theta = s.angles().t[1];
            Some(((theta + 0.0 - theta).sin().abs() - theta.sin().abs()).abs())
        },
        unit: "in the sine",
        aside: None,
        clockwise: None,
        corrected: Some((
            "lg12 lg13 sin(θ_lg12 - θ_lg13) = 0, so sin θ_lg1 = 0",
            |s| {
                let (leg, theta) = (&s.lizard.leg, s.angles().t[1]);
                // Columns by θ_lg12 = 0 and θ_lg13 = θ_lg1.
                let columns = [
                    0.0,
                    leg.follower * theta.sin(),
                    leg.coupler,
                    -leg.follower * theta.cos(),
                ];
                let truth = (0.0 - theta).sin();
                Some((-determinant_sine(&columns, leg.coupler * leg.follower) - truth).abs())
            },
        )),
    },
];

/// theta1 where every slider is at nominal: the neutral pose, degrees.
fn home_angle(s: &Sample) -> f64 {
    let l = &s.lizard.links;
    ((l.l12 + l.l13 - l.l10) / (l.l11 + l.l14))
        .acos()
        .to_degrees()
}

/// The head's type-2 margin at the neutral pose, and theta2 + theta3 there in
/// radians.
fn neutral(s: &Sample) -> Option<(f64, f64)> {
    let theta1 = home_angle(s);
    let pose = s
        .lizard
        .end(End::Head)
        .forward(theta1, 180.0 - theta1)
        .ok()?;
    let sum = pose.theta_left_coupler() + pose.theta_right_coupler();
    Some((pose.type2, sum.to_radians()))
}

const HEAD: [usize; 3] = [2, 2, 3];
const TAIL: [usize; 3] = [6, 7, 8];

/// The largest difference of two 2x2 blocks, given by rows.
fn against(truth: &[f64; 4], block: &[f64; 4]) -> f64 {
    truth
        .iter()
        .zip(block)
        .fold(0.0, |worst, (a, b)| worst.max((a - b).abs()))
}

/// A block of the true K: two rows, and the columns of two servos.
fn k(s: &Sample, row: usize, first: usize, second: usize) -> [f64; 4] {
    let k = s.s.active_matrix();
    [
        k[row][first],
        k[row][second],
        k[row + 1][first],
        k[row + 1][second],
    ]
}

/// A diagonal block of the true K*.
fn passive(s: &Sample, at: usize) -> [f64; 4] {
    let k = s.s.passive_matrix();
    [k[at][at], k[at][at + 1], k[at + 1][at], k[at + 1][at + 1]]
}

fn k_head(s: &Sample, theta4: f64) -> [f64; 4] {
    let (l, t) = (&s.lizard.links, s.angles().t);
    [
        -l.l1 * t[1].sin(),
        -l.l4 * theta4.sin(),
        l.l1 * t[1].cos(),
        -l.l4 * theta4.cos(),
    ]
}

fn k_tail(s: &Sample, theta8: f64) -> [f64; 4] {
    let (l, t) = (&s.lizard.links, s.angles().t);
    [
        -l.l6 * t[5].sin(),
        -l.l9 * theta8.sin(),
        l.l6 * t[5].cos(),
        -l.l9 * theta8.cos(),
    ]
}

/// A printed side block: rear arm, then front arm with the sign of its sine.
fn side([rear, front]: [f64; 2], rear_angle: f64, front_angle: f64, sign: f64) -> [f64; 4] {
    [
        rear * rear_angle.sin(),
        sign * front * front_angle.sin(),
        rear * rear_angle.cos(),
        -front * front_angle.cos(),
    ]
}

/// A coupler block of K*: angle of the left coupler, and its two links; the
/// sign of the second sine.
fn k_star(s: &Sample, [left, a, b]: [usize; 3], right: f64, sign: f64) -> [f64; 4] {
    let (l, t) = (s.lizard.links.to_array(), s.angles().t);
    [
        -l[a] * t[left].sin(),
        sign * l[b] * right.sin(),
        l[a] * t[left].cos(),
        -l[b] * right.cos(),
    ]
}

/// The determinant of a coupler block over its lengths, turned so that it is
/// the sine of right less left.
fn determinant_sine([a, b, c, d]: &[f64; 4], lengths: f64) -> f64 {
    -(a * d - b * c) / lengths
}

fn mobility_of_leg(s: &Sample) -> f64 {
    crate::paper::mobility::leg_freedoms(&s.lizard, &s.s) as f64
}
