//! The same mechanisms solved in another way: Newton's method on the loop
//! equations in joint angles, and circles met by the law of cosines. Nothing
//! here uses the crate's construction, only its lengths.

use std::f64::consts::PI;

use lizard_kinematics::{FiveBar, Leg, Lizard};
use proptest::prelude::*;

/// The robot of the paper.
pub const HEAD: FiveBar = FiveBar {
    base: 20.0,
    crank_left: 30.0,
    coupler_left: 50.0,
    coupler_right: 50.0,
    crank_right: 30.0,
};

pub fn lizard() -> Lizard {
    let mut l = [30.0; 20];
    for (length, links) in [
        (20.0, &[0, 5][..]),
        (50.0, &[2, 3, 7, 8]),
        (45.0, &[12, 13, 17, 18]),
        (135.0, &[10, 15]),
    ] {
        for &i in links {
            l[i] = length;
        }
    }
    Lizard {
        links: l.into(),
        leg: Leg {
            ground: 50.0,
            crank: 45.0,
            coupler: 50.0,
            follower: 45.0,
        },
    }
}

/// l1 cis theta1 + l2 cis theta2 - l3 cis theta3 - l4 cis theta4 - l0, in mm.
pub fn loop_gap(bars: &FiveBar, degrees: [f64; 4]) -> [f64; 2] {
    let [t1, t2, t3, t4] = degrees.map(|d| d * PI / 180.0);
    let (l1, l2) = (bars.crank_left, bars.coupler_left);
    let (l3, l4) = (bars.coupler_right, bars.crank_right);
    [
        l1 * t1.cos() + l2 * t2.cos() - l3 * t3.cos() - l4 * t4.cos() - bars.base,
        l1 * t1.sin() + l2 * t2.sin() - l3 * t3.sin() - l4 * t4.sin(),
    ]
}

/// theta2, theta3 in degrees by Newton from a start, or None if it wanders off.
pub fn newton(bars: &FiveBar, cranks: [f64; 2], start: [f64; 2]) -> Option<[f64; 2]> {
    let [mut t2, mut t3] = start;
    for _ in 0..60 {
        let [fx, fy] = loop_gap(bars, [cranks[0], t2, t3, cranks[1]]);
        if fx.hypot(fy) < 1e-11 {
            return Some([t2, t3]);
        }
        let (a, b) = (t2 * PI / 180.0, t3 * PI / 180.0);
        let (l2, l3) = (bars.coupler_left, bars.coupler_right);
        let det = l2 * l3 * (a - b).sin();
        let da = (l3 * b.cos() * fx + l3 * b.sin() * fy) / det;
        let db = (l2 * a.cos() * fx + l2 * a.sin() * fy) / det;
        t2 += da.clamp(-0.5, 0.5) * 180.0 / PI;
        t3 += db.clamp(-0.5, 0.5) * 180.0 / PI;
    }
    let [fx, fy] = loop_gap(bars, [cranks[0], t2, t3, cranks[1]]);
    (fx.hypot(fy) < 1e-10).then_some([t2, t3])
}

/// The apex by the law of cosines at the left crank tip, left of the line
/// between the tips; None if the circles miss each other.
pub fn apex(bars: &FiveBar, theta_left: f64, theta_right: f64) -> Option<[f64; 2]> {
    let (a, b) = (theta_left * PI / 180.0, theta_right * PI / 180.0);
    let (bx, by) = (
        bars.crank_left * a.cos() - bars.base / 2.0,
        bars.crank_left * a.sin(),
    );
    let (cx, cy) = (
        bars.crank_right * b.cos() + bars.base / 2.0,
        bars.crank_right * b.sin(),
    );
    let d = (cx - bx).hypot(cy - by);
    let (l2, l3) = (bars.coupler_left, bars.coupler_right);
    let cosine = (l2 * l2 + d * d - l3 * l3) / (2.0 * l2 * d);
    if cosine.is_nan() || cosine.abs() > 1.0 {
        return None;
    }
    let t2 = (cy - by).atan2(cx - bx) + cosine.acos();
    Some([bx + l2 * t2.cos(), by + l2 * t2.sin()])
}

/// Robots of any proportions that come together: random links, l10 = l15.
pub fn any_lizard() -> impl Strategy<Value = Lizard> {
    proptest::collection::vec(0.6..1.6f64, 20).prop_map(|factors| {
        let paper = lizard();
        let mut l = paper.links.to_array();
        for (length, factor) in l.iter_mut().zip(factors) {
            *length *= factor;
        }
        l[15] = l[10];
        Lizard {
            links: l.into(),
            ..paper
        }
    })
}
