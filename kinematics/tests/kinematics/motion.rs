//! Rates, accelerations and Jacobians against finite differences of positions.

#![allow(clippy::needless_range_loop)] // Matrices read best with their indices.

use lizard_kinematics::{Drive, Lizard, Pose, Solution, wrap};
use proptest::prelude::*;

use crate::reference::{any_lizard, lizard};

/// Longest step of the central differences, s.
const STEP: f64 = 1e-4;
/// No angle turns by more than about this in a step, deg.
const TURN: f64 = 0.1;

/// Every passive quantity in the order of [`numbers`].
fn values(s: &Solution) -> [f64; 12] {
    let (head, tail) = (s.head_point(), s.tail_point());
    [
        s.theta2(),
        s.theta3(),
        s.theta6(),
        s.theta7(),
        s.left.phi(),
        s.right.phi(),
        head.x,
        head.y,
        tail.x,
        tail.y,
        s.left.s,
        s.right.s,
    ]
}

/// Rates and accelerations in the order of [`values`].
fn numbers(s: &Solution, drive: &Drive) -> ([f64; 12], [f64; 12]) {
    let m = s.motion(drive);
    (
        [
            m.theta2.rate,
            m.theta3.rate,
            m.theta6.rate,
            m.theta7.rate,
            m.phi_left.rate,
            m.phi_right.rate,
            m.head.rate.x,
            m.head.rate.y,
            m.tail.rate.x,
            m.tail.rate.y,
            m.s_left.rate,
            m.s_right.rate,
        ],
        [
            m.theta2.acceleration,
            m.theta3.acceleration,
            m.theta6.acceleration,
            m.theta7.acceleration,
            m.phi_left.acceleration,
            m.phi_right.acceleration,
            m.head.acceleration.x,
            m.head.acceleration.y,
            m.tail.acceleration.x,
            m.tail.acceleration.y,
            m.s_left.acceleration,
            m.s_right.acceleration,
        ],
    )
}

/// The robot `t` seconds later, under constant servo accelerations.
fn later(robot: &Lizard, pose: [f64; 4], drive: &Drive, t: f64) -> Option<Solution> {
    let mut there = pose;
    for (i, angle) in there.iter_mut().enumerate() {
        *angle += drive.rate[i] * t + drive.acceleration[i] * t * t / 2.0;
    }
    robot.solve(&Pose::from(there)).ok()
}

fn angles() -> impl Strategy<Value = [f64; 4]> {
    [0.0..180.0, 0.0..180.0, 180.0..360.0, 180.0..360.0f64]
}

fn drives() -> impl Strategy<Value = Drive> {
    let four = |most: f64| [-most..most, -most..most, -most..most, -most..most];
    (four(300.0), four(2000.0)).prop_map(|(rate, acceleration)| Drive { rate, acceleration })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2048, failure_persistence: None, max_global_rejects: 100_000,
        ..ProptestConfig::default()
    })]

    #[test]
    fn rates_and_accelerations_are_the_differences_of_positions(
        robot in any_lizard(), pose in angles(), drive in drives(),
    ) {
        let now = robot.solve(&pose.into());
        prop_assume!(now.is_ok());
        let now = now.unwrap();
        // Near a singularity the third derivative swamps any fixed step.
        prop_assume!(now.margins.type2[0] > 0.3 && now.margins.type2[1] > 0.3);
        prop_assume!(now.head.gap.length() > 5.0 && now.tail.gap.length() > 5.0);
        prop_assume!(now.left.d > 20.0 && now.right.d > 20.0);
        let (rates, accelerations) = numbers(&now, &drive);
        let largest = |all: &[f64; 12]| all.iter().fold(1.0_f64, |most, v| most.max(v.abs()));
        let (fast, hard) = (largest(&rates), largest(&accelerations));
        let step = STEP.min(TURN / fast);
        // Five points: error of the fourth order in the step.
        let at = |steps: f64| later(&robot, pose, &drive, steps * step).map(|s| values(&s));
        let here = values(&now);
        let [Some(a), Some(b), Some(d), Some(e)] = [-2.0, -1.0, 1.0, 2.0].map(at) else {
            return Err(TestCaseError::fail("a neighbour does not close"));
        };
        for i in 0..12 {
            let from_here = |there: f64| {
                if i < 6 { wrap(there - here[i]) } else { there - here[i] }
            };
            let [a, b, d, e] = [a[i], b[i], d[i], e[i]].map(from_here);
            let rate = (a - 8.0 * b + 8.0 * d - e) / (12.0 * step);
            let acceleration = (16.0 * (b + d) - a - e) / (12.0 * step * step);
            prop_assert!((rate - rates[i]).abs() < 1e-6 * fast, "{i}: {rate} {}", rates[i]);
            prop_assert!(
                (acceleration - accelerations[i]).abs() < 1e-6 * hard.max(100.0),
                "{i}: {acceleration} {}", accelerations[i]
            );
        }
    }

    #[test]
    fn k_and_k_star_are_the_derivatives_of_the_loop_equations(
        robot in any_lizard(), pose in angles(),
    ) {
        let solved = robot.solve(&pose.into());
        prop_assume!(solved.is_ok());
        let solved = solved.unwrap();
        let passive = solved.passive();
        let step = 1e-4;
        let radian = 1f64.to_degrees();
        let k = solved.active_matrix();
        for column in 0..4 {
            let moved = |by: f64| {
                let mut active = pose;
                active[column] += by * radian;
                robot.residual(active, &passive)
            };
            let (up, down) = (moved(step), moved(-step));
            for row in 0..8 {
                let slope = (up[row] - down[row]) / (2.0 * step);
                prop_assert!((slope - k[row][column]).abs() < 1e-6 * 200.0, "K {row} {column}");
            }
        }
        let k = solved.passive_matrix();
        for column in 0..8 {
            let moved = |by: f64| {
                let mut p = passive;
                let field = [
                    &mut p.theta2, &mut p.theta3, &mut p.theta6, &mut p.theta7,
                    &mut p.phi_left, &mut p.s_left, &mut p.phi_right, &mut p.s_right,
                ].into_iter().nth(column).unwrap();
                *field += if matches!(column, 5 | 7) { by } else { by * radian };
                robot.residual(pose, &p)
            };
            let (up, down) = (moved(step), moved(-step));
            for row in 0..8 {
                let slope = (up[row] - down[row]) / (2.0 * step);
                prop_assert!((slope - k[row][column]).abs() < 1e-6 * 200.0, "K* {row} {column}");
            }
        }
    }

    #[test]
    fn the_blocks_multiply_to_the_determinant_of_k_star(
        robot in any_lizard(), pose in angles(),
    ) {
        let solved = robot.solve(&pose.into());
        prop_assume!(solved.is_ok());
        let solved = solved.unwrap();
        let product = solved.blocks().determinant();
        let eliminated = determinant(solved.passive_matrix());
        let l = robot.links;
        let scale = l.l2 * l.l3 * l.l7 * l.l8 * solved.left.d * solved.right.d;
        prop_assert!((product - eliminated).abs() < 1e-9 * scale, "{product} {eliminated}");
    }

    #[test]
    fn the_jacobian_moves_the_head_as_the_rates_do(
        pose in angles(), rate in [-300.0..300.0, -300.0..300.0f64],
    ) {
        let solved = lizard().solve(&pose.into());
        prop_assume!(solved.is_ok());
        let solved = solved.unwrap();
        prop_assume!(solved.head.type2 > 1e-3);
        let drive = Drive { rate: [rate[0], rate[1], 0.0, 0.0], ..Drive::default() };
        let truth = solved.motion(&drive).head.rate;
        let j = solved.head.jacobian();
        let ours = j.left * rate[0].to_radians() + j.right * rate[1].to_radians();
        prop_assert!((truth - ours).length() < 1e-9 * (1.0 + truth.length()) / solved.head.type2);
        let [largest, smallest] = j.singular_values();
        prop_assert!((smallest / largest - solved.head.lci()).abs() < 1e-9);
        prop_assert!((largest * smallest - j.determinant().abs()).abs() < 1e-9 * largest * largest);
    }
}

/// By Gauss with pivoting.
fn determinant(mut m: [[f64; 8]; 8]) -> f64 {
    let mut product = 1.0;
    for i in 0..8 {
        let pivot = (i..8)
            .max_by(|&a, &b| m[a][i].abs().total_cmp(&m[b][i].abs()))
            .unwrap();
        if pivot != i {
            m.swap(pivot, i);
            product = -product;
        }
        product *= m[i][i];
        if m[i][i] == 0.0 {
            return 0.0;
        }
        for row in i + 1..8 {
            let factor = m[row][i] / m[i][i];
            for column in i..8 {
                m[row][column] -= factor * m[i][column];
            }
        }
    }
    product
}
