//! Random robots, and reference solutions of the same mechanisms: by Newton's method on the loop equations, and by
//! intersecting circles, with the law of cosines. The solutions share only the link lengths with the crate.

#![allow(dead_code)] // Unit tests and integration tests use different parts.

use std::f64::consts::PI;

use lizard_kinematics::{FiveBar, Leg, Lizard, Solution, Vector};
use proptest::prelude::*;

/// The head of the paper's robot.
pub const PAPER_HEAD: FiveBar = FiveBar::new([20.0, 30.0, 50.0, 50.0, 30.0]);

/// The paper's robot.
pub fn paper_lizard() -> Lizard {
    let end = [20.0, 30.0, 50.0, 50.0, 30.0];
    let side = [135.0, 30.0, 45.0, 45.0, 30.0];
    let links: [f64; 20] = [end, end, side, side].concat().try_into().unwrap();
    Lizard {
        links: links.into(),
        leg: Leg {
            ground: 50.0,
            crank: 45.0,
            coupler: 50.0,
            follower: 45.0,
        },
    }
}

/// The x and y residuals of the loop equation l1 cis(theta1) + l2 cis(theta2) - l3 cis(theta3) - l4 cis(theta4) - l0,
/// mm, at theta1 to theta4 in degrees.
pub fn loop_residuals(five_bar: &FiveBar, degrees: [f64; 4]) -> [f64; 2] {
    let [t1, t2, t3, t4] = degrees.map(|d| d * PI / 180.0);
    let (l1, l2) = (five_bar.left_crank_length, five_bar.left_coupler_length);
    let (l3, l4) = (five_bar.right_coupler_length, five_bar.right_crank_length);
    [
        l1 * t1.cos() + l2 * t2.cos() - l3 * t3.cos() - l4 * t4.cos() - five_bar.base,
        l1 * t1.sin() + l2 * t2.sin() - l3 * t3.sin() - l4 * t4.sin(),
    ]
}

/// Computes theta2 and theta3 (degrees) by Newton's method from the values in `start`; `None` if it does not converge.
/// `cranks` are the angles of both cranks, degrees.
pub fn solve_by_newton(five_bar: &FiveBar, cranks: [f64; 2], start: [f64; 2]) -> Option<[f64; 2]> {
    let [mut t2, mut t3] = start;
    for _ in 0..60 {
        let [fx, fy] = loop_residuals(five_bar, [cranks[0], t2, t3, cranks[1]]);
        if fx.hypot(fy) < 1e-11 {
            return Some([t2, t3]);
        }
        let (a, b) = (t2 * PI / 180.0, t3 * PI / 180.0);
        let (l2, l3) = (five_bar.left_coupler_length, five_bar.right_coupler_length);
        let det = l2 * l3 * (a - b).sin();
        let da = (l3 * b.cos() * fx + l3 * b.sin() * fy) / det;
        let db = (l2 * a.cos() * fx + l2 * a.sin() * fy) / det;
        t2 += da.clamp(-0.5, 0.5) * 180.0 / PI;
        t3 += db.clamp(-0.5, 0.5) * 180.0 / PI;
    }
    let [fx, fy] = loop_residuals(five_bar, [cranks[0], t2, t3, cranks[1]]);
    (fx.hypot(fy) < 1e-10).then_some([t2, t3])
}

/// Computes the end point to the left of the line from the left crank tip to the right one, by the law of cosines;
/// `None` if the couplers' circles do not intersect.
pub fn end_point_by_cosines(
    five_bar: &FiveBar,
    theta_left: f64,
    theta_right: f64,
) -> Option<Vector> {
    let (a, b) = (theta_left * PI / 180.0, theta_right * PI / 180.0);
    let half_base = five_bar.base / 2.0;
    let (l1, l4) = (five_bar.left_crank_length, five_bar.right_crank_length);
    let (l2, l3) = (five_bar.left_coupler_length, five_bar.right_coupler_length);
    let left = Vector::new(l1 * a.cos() - half_base, l1 * a.sin());
    let right = Vector::new(l4 * b.cos() + half_base, l4 * b.sin());
    circle_intersection(left, l2, right, l3)
}

/// Robots of random proportions: each link is 0.6 to 1.6 times as long as that of the paper's robot, and l10 = l15.
pub fn any_lizard() -> impl Strategy<Value = Lizard> {
    proptest::collection::vec(0.6..1.6f64, 20).prop_map(|factors| {
        let paper = paper_lizard();
        let mut lengths = paper.links.to_array();
        for (length, factor) in lengths.iter_mut().zip(factors) {
            *length *= factor;
        }
        lengths[15] = lengths[10];
        Lizard {
            links: lengths.into(),
            ..paper
        }
    })
}

/// Random robots, each with a pose in which all loops close, and with its solution.
pub fn any_solved_lizard() -> impl Strategy<Value = (Lizard, [f64; 4], Solution)> {
    (any_lizard(), any_pose()).prop_filter_map("a loop does not close", |(lizard, pose)| {
        let solution = lizard.solve(&pose.into()).ok()?;
        Some((lizard, pose, solution))
    })
}

/// A proptest configuration with this number of cases that tolerates many rejected ones.
pub fn config_with_cases(case_count: u32) -> ProptestConfig {
    ProptestConfig {
        cases: case_count,
        max_global_rejects: 100_000,
        max_local_rejects: 1_000_000,
        ..ProptestConfig::default()
    }
}

/// Servo angles (degrees, servo order) at which the loops of most robots close.
pub fn any_pose() -> impl Strategy<Value = [f64; 4]> {
    [0.0..180.0, 0.0..180.0, 180.0..360.0, 180.0..360.0f64]
}

/// The unit vector at an angle in degrees.
pub fn cis(degrees: f64) -> Vector {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vector::new(cos, sin)
}

/// The joint between a link of length `r` that is pivoted at `a` and a link of length `s` that is pivoted at `b`, to
/// the left of the line from `a` to `b`, by the law of cosines; `None` if the links cannot reach each other.
pub fn circle_intersection(a: Vector, r: f64, b: Vector, s: f64) -> Option<Vector> {
    let d = (b.x - a.x).hypot(b.y - a.y);
    let cosine = (r * r + d * d - s * s) / (2.0 * r * d);
    if cosine.is_nan() || cosine.abs() > 1.0 {
        return None;
    }
    let angle = (b.y - a.y).atan2(b.x - a.x) + cosine.acos();
    Some(Vector::new(a.x + r * angle.cos(), a.y + r * angle.sin()))
}
