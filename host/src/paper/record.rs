//! A solved pose as `lizard solve` prints it.

use std::fmt::Write as _;

use lizard_kinematics::{Infeasible, Limits, Margins, Pose, Solution, Vector};
use serde::Serialize;

/// One object of `lizard solve --json`. Everything that a pose without a
/// solution lacks is null.
#[derive(Serialize)]
pub struct Record {
    theta2: Option<f64>,
    theta3: Option<f64>,
    theta6: Option<f64>,
    theta7: Option<f64>,
    head: Option<[f64; 2]>,
    tail: Option<[f64; 2]>,
    left: Option<Side>,
    right: Option<Side>,
    legs: Option<Legs>,
    margins: Option<Sines>,
    safe: bool,
    why: Vec<String>,
}

#[derive(Serialize)]
struct Side {
    phi: f64,
    s: f64,
}

#[derive(Serialize)]
struct Legs {
    lf: Leg,
    rf: Leg,
    rh: Leg,
    lh: Leg,
}

#[derive(Serialize)]
struct Leg {
    follower: f64,
    coupler: f64,
}

#[derive(Serialize)]
struct Sines {
    type2_head: f64,
    type2_tail: f64,
    type1_a1: f64,
    type1_a2: f64,
    type1_a3: f64,
    type1_a4: f64,
    leg_lf: f64,
    leg_rf: f64,
    leg_rh: f64,
    leg_lh: f64,
}

impl From<&Margins> for Sines {
    fn from(m: &Margins) -> Self {
        let [type2_head, type2_tail] = m.type2;
        let [type1_a1, type1_a2, type1_a3, type1_a4] = m.type1;
        let [leg_lf, leg_rf, leg_rh, leg_lh] = m.leg;
        Self {
            type2_head,
            type2_tail,
            type1_a1,
            type1_a2,
            type1_a3,
            type1_a4,
            leg_lf,
            leg_rf,
            leg_rh,
            leg_lh,
        }
    }
}

impl Record {
    /// The record of a pose, solved or not.
    pub fn new(solved: &Result<Solution, Infeasible>, limits: &Limits) -> Self {
        let s = match solved {
            Ok(solution) => solution,
            Err(infeasible) => return Self::without(infeasible),
        };
        let why: Vec<String> = limits.violations(s).map(|v| v.to_string()).collect();
        let (head, tail) = (s.head_point(), s.tail_point());
        let p = s.passive();
        let [lf, rf, rh, lh] = s.legs.map(|leg| Leg {
            follower: leg.follower(),
            coupler: leg.coupler(),
        });
        Self {
            theta2: Some(p.theta2),
            theta3: Some(p.theta3),
            theta6: Some(p.theta6),
            theta7: Some(p.theta7),
            head: Some([head.x, head.y]),
            tail: Some([tail.x, tail.y]),
            left: Some(Side {
                phi: p.phi_left,
                s: s.left.s,
            }),
            right: Some(Side {
                phi: p.phi_right,
                s: s.right.s,
            }),
            legs: Some(Legs { lf, rf, rh, lh }),
            margins: Some(Sines::from(&s.margins)),
            safe: why.is_empty(),
            why,
        }
    }

    fn without(infeasible: &Infeasible) -> Self {
        Self {
            theta2: None,
            theta3: None,
            theta6: None,
            theta7: None,
            head: None,
            tail: None,
            left: None,
            right: None,
            legs: None,
            margins: None,
            safe: false,
            why: vec![infeasible.to_string()],
        }
    }
}

/// The heading of [`row`], in the same columns.
pub fn heading() -> String {
    format!(
        " {:>8} {:>8} {:>8} {:>8} | {:>8} {:>8} {:>8} {:>8} | {:>17} {:>17} | {:>7} {:>7} | {:17} | safe, or why not",
        "theta1",
        "theta4",
        "theta8",
        "theta5",
        "theta2",
        "theta3",
        "theta6",
        "theta7",
        "head x, y mm",
        "tail x, y mm",
        "s left",
        "s right",
        "least margin",
    )
}

/// A solved pose in one line of a table.
pub fn row(pose: &Pose, solved: &Result<Solution, Infeasible>, limits: &Limits) -> String {
    let angles = <[f64; 4]>::from(*pose);
    let mut line = String::with_capacity(192);
    for angle in angles {
        let _ = write!(line, " {angle:8.3}");
    }
    let s = match solved {
        Err(infeasible) => {
            let _ = write!(line, " | {infeasible}");
            return line;
        }
        Ok(solution) => solution,
    };
    let (head, tail) = (tidy(s.head_point()), tidy(s.tail_point()));
    let (least, value) = s.margins.min();
    let _ = write!(
        line,
        " | {:8.3} {:8.3} {:8.3} {:8.3} | {:8.3} {:8.3} {:8.3} {:8.3} | {:+7.2} {:+7.2} | {least:9} {value:+7.4} | ",
        s.theta2(),
        s.theta3(),
        s.theta6(),
        s.theta7(),
        head.x,
        head.y,
        tail.x,
        tail.y,
        s.left.s,
        s.right.s,
    );
    match limits.violations(s).next() {
        None => line.push_str("safe"),
        Some(violation) => {
            let _ = write!(line, "{violation}");
        }
    }
    line
}

/// A solved pose as a page.
pub fn page(pose: &Pose, solved: &Result<Solution, Infeasible>, limits: &Limits) -> String {
    let [a1, a2, a3, a4] = <[f64; 4]>::from(*pose);
    let mut page = format!(
        "servos   A1 theta1 {a1:9.3}   A2 theta4 {a2:9.3}   A3 theta8 {a3:9.3}   A4 theta5 {a4:9.3}  deg\n"
    );
    let s = match solved {
        Err(infeasible) => {
            let _ = writeln!(page, "\nno solution: {infeasible}");
            return page;
        }
        Ok(solution) => solution,
    };
    let (head, tail) = (tidy(s.head_point()), tidy(s.tail_point()));
    let legs = s.legs.map(|leg| leg.follower());
    let m = &s.margins;
    let _ = write!(
        page,
        "
head     ({:8.3}, {:8.3}) mm   theta2 {:8.3}   theta3 {:8.3} deg
tail     ({:8.3}, {:8.3}) mm   theta6 {:8.3}   theta7 {:8.3} deg
left     s {:+8.3} mm   phi {:8.3} deg
right    s {:+8.3} mm   phi {:8.3} deg
legs     followers  front left {:8.3}   front right {:8.3}   back right {:8.3}   back left {:8.3} deg

margins  (0 is singular, 1 is best)  limits {} {} {}
         type-2    head {:+.4}   tail {:+.4}
         type-1    A1   {:+.4}   A2   {:+.4}   A3 {:+.4}   A4 {:+.4}
         legs      LF   {:+.4}   RF   {:+.4}   RH {:+.4}   LH {:+.4}

",
        head.x, head.y, s.theta2(), s.theta3(),
        tail.x, tail.y, s.theta6(), s.theta7(),
        s.left.s, s.left.phi(),
        s.right.s, s.right.phi(),
        legs[0], legs[1], legs[2], legs[3],
        limits.type2, limits.type1, limits.leg,
        m.type2[0], m.type2[1],
        m.type1[0], m.type1[1], m.type1[2], m.type1[3],
        m.leg[0], m.leg[1], m.leg[2], m.leg[3],
    );
    let broken: Vec<_> = limits.violations(s).collect();
    if broken.is_empty() {
        let (least, value) = m.min();
        let _ = writeln!(page, "safe     yes, the least margin is {least} {value:.4}");
    } else {
        for (i, violation) in broken.iter().enumerate() {
            let lead = if i == 0 {
                "safe     no, "
            } else {
                "             "
            };
            let _ = writeln!(page, "{lead}{violation}");
        }
    }
    page
}

/// A point to the micrometre, without a negative zero.
fn tidy(point: Vector) -> Vector {
    let round = |value: f64| (value * 1e3).round() / 1e3 + 0.0;
    Vector::new(round(point.x), round(point.y))
}
