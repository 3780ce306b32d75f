//! The eight loop equations of the body and their Jacobians K and K*.
//!
//! The paper prints K as 8x8 and takes its determinant; there are only four active rates, so K is 8x4 and has no
//! determinant. K* is 8x8 and block diagonal, and its determinant is the product of four block determinants. The rows
//! are the x and y of the head, tail, left and right loops, mm. All are in the chassis frame and angles are
//! counter-clockwise, so several entries have the opposite sign to the printed ones.

use crate::end::End;
use crate::lizard::{Lizard, Solution};
use crate::side::Side;
use crate::vector::Vector;

/// The passive joints, chassis frame. phi and s of a slider stand for the
/// paper's theta10, theta11 (right: theta14, theta15).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassiveJoints {
    /// Head, left coupler: degrees, (-180, 180].
    pub theta2: f64,
    /// Head, right coupler: degrees, (-180, 180].
    pub theta3: f64,
    /// Tail, left coupler: degrees, (-180, 180].
    pub theta6: f64,
    /// Tail, right coupler: degrees, (-180, 180].
    pub theta7: f64,
    /// Direction of the left slider, rear to front: degrees, (-180, 180].
    pub phi_left: f64,
    /// Travel of the left slider from nominal, mm.
    pub s_left: f64,
    /// Direction of the right slider, rear to front: degrees, (-180, 180].
    pub phi_right: f64,
    /// Travel of the right slider from nominal, mm.
    pub s_right: f64,
}

/// Determinants of the four diagonal blocks of K*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockDeterminants {
    /// l2 l3 sin(theta2 - theta3), mm^2.
    pub head: f64,
    /// l7 l8 sin(theta6 - theta7), mm^2.
    pub tail: f64,
    /// -d of the left slider, mm.
    pub left: f64,
    /// -d of the right slider, mm.
    pub right: f64,
}

impl BlockDeterminants {
    /// det K*, mm^6: the product of the four block determinants.
    pub fn determinant(&self) -> f64 {
        self.head * self.tail * self.left * self.right
    }
}

impl Solution {
    /// The passive joints of this solution.
    pub fn passive(&self) -> PassiveJoints {
        PassiveJoints {
            theta2: self.theta2(),
            theta3: self.theta3(),
            theta6: self.theta6(),
            theta7: self.theta7(),
            phi_left: self.left.phi(),
            s_left: self.left.s,
            phi_right: self.right.phi(),
            s_right: self.right.s,
        }
    }

    /// K: derivatives of the loop equations with respect to theta1, theta4, theta8, theta5, mm per radian. 8x4.
    pub fn active_matrix(&self) -> [[f64; 4]; 8] {
        let mut k = [[0.0; 4]; 8];
        for (row, end) in ROWS.into_iter().zip(End::ALL) {
            let ([left, right], pose) = (end.servos(), self.end(end));
            let bars = &pose.bars;
            let crank = end.mirror(pose.left_crank) * bars.crank_left;
            put_entry(&mut k, row, left, crank.rotated_left());
            let crank = end.mirror(pose.right_crank) * bars.crank_right;
            put_entry(&mut k, row, right, -crank.rotated_left());
        }
        for (row, side) in ROWS.into_iter().skip(2).zip(Side::ALL) {
            let ([front, rear], pose) = (side.servos(), self.side(side));
            put_entry(&mut k, row, front, pose.front_arm().rotated_left());
            put_entry(&mut k, row, rear, -pose.rear_tip.rotated_left());
        }
        k
    }

    /// K*: derivatives of the loop equations with respect to theta2, theta3, theta6, theta7, phi and s left, phi and
    /// s right, mm per radian and mm per mm. 8x8.
    pub fn passive_matrix(&self) -> [[f64; 8]; 8] {
        let mut k = [[0.0; 8]; 8];
        for (row, end) in ROWS.into_iter().zip(End::ALL) {
            let ([left, right], bars) = (self.couplers(end), &self.end(end).bars);
            put_entry(&mut k, row, row, (left * bars.coupler_left).rotated_left());
            put_entry(
                &mut k,
                row,
                row + 1,
                -(right * bars.coupler_right).rotated_left(),
            );
        }
        for (row, side) in ROWS.into_iter().skip(2).zip(Side::ALL) {
            let slider = self.side(side);
            put_entry(&mut k, row, row, -slider.span.rotated_left());
            put_entry(&mut k, row, row + 1, slider.span * (-1.0 / slider.d));
        }
        k
    }

    /// The determinants of the blocks of K*, whose product is det K*.
    pub fn blocks(&self) -> BlockDeterminants {
        let block_of = |end: End| {
            let pose = self.end(end);
            let lengths = pose.bars.coupler_left * pose.bars.coupler_right;
            // Mirroring changes the sign of the sine.
            -end.sign() * lengths * pose.type2
        };
        BlockDeterminants {
            head: block_of(End::Head),
            tail: block_of(End::Tail),
            left: -self.left.d,
            right: -self.right.d,
        }
    }
}

impl Lizard {
    /// The residuals of the eight loop equations for any values of the joints, mm; zero at
    /// a solution. Active angles in servo order.
    pub fn residual(&self, active: [f64; 4], passive: &PassiveJoints) -> [f64; 8] {
        let (shafts, cis) = (self.shafts(), Vector::direction);
        let couplers = [
            [passive.theta2, passive.theta3],
            [passive.theta6, passive.theta7],
        ];
        let sliders = [
            (passive.phi_left, passive.s_left),
            (passive.phi_right, passive.s_right),
        ];
        let mut residual = [0.0; 8];
        let mut put_gap = |row: usize, gap: Vector| {
            (residual[row], residual[row + 1]) = (gap.x, gap.y);
        };
        for ((row, end), theta) in ROWS.into_iter().zip(End::ALL).zip(couplers) {
            let ([left, right], bars) = (end.servos(), self.end(end));
            let gap = shafts[left]
                + cis(active[left]) * bars.crank_left
                + cis(theta[0]) * bars.coupler_left
                - (shafts[right]
                    + cis(active[right]) * bars.crank_right
                    + cis(theta[1]) * bars.coupler_right);
            put_gap(row, gap);
        }
        for ((row, side), (phi, s)) in ROWS.into_iter().skip(2).zip(Side::ALL).zip(sliders) {
            let ([front, rear], slider) = (side.servos(), self.side(side));
            let right_angle = 90.0 * side.sign();
            let gap = shafts[front] + cis(active[front] + right_angle) * slider.front
                - (shafts[rear] + cis(active[rear] - right_angle) * slider.rear)
                - cis(phi) * (slider.nominal + s);
            put_gap(row, gap);
        }
        residual
    }
}

/// The first row of each loop in K and K*: head, tail, left, right. In K* these are also
/// the first columns of the loops.
const ROWS: [usize; 4] = [0, 2, 4, 6];

/// Writes the derivative of one loop by one joint: its x and y rows, in the joint's column.
fn put_entry<const N: usize>(matrix: &mut [[f64; N]; 8], row: usize, column: usize, entry: Vector) {
    matrix[row][column] = entry.x;
    matrix[row + 1][column] = entry.y;
}

#[cfg(test)]
#[allow(clippy::needless_range_loop)] // Matrices read best with their indices.
mod tests {
    use proptest::prelude::*;

    use crate::reference::{any_solved, cases};

    proptest! {
        #![proptest_config(cases(2048))]

        #[test]
        fn k_and_k_star_are_the_derivatives_of_the_loop_equations(
            (robot, pose, solution) in any_solved(),
        ) {
            let passive = solution.passive();
            let step = 1e-4;
            let radian = 1f64.to_degrees();
            let k = solution.active_matrix();
            for column in 0..4 {
                let residual_after = |step_size: f64| {
                    let mut active = pose;
                    active[column] += step_size * radian;
                    robot.residual(active, &passive)
                };
                let (residual_above, residual_below) = (residual_after(step), residual_after(-step));
                for row in 0..8 {
                    let slope = (residual_above[row] - residual_below[row]) / (2.0 * step);
                    prop_assert!((slope - k[row][column]).abs() < 1e-6 * 200.0, "K {row} {column}");
                }
            }
            let k = solution.passive_matrix();
            for column in 0..8 {
                let residual_after = |step_size: f64| {
                    let mut shifted = passive;
                    let field = [
                        &mut shifted.theta2, &mut shifted.theta3, &mut shifted.theta6, &mut shifted.theta7,
                        &mut shifted.phi_left, &mut shifted.s_left, &mut shifted.phi_right, &mut shifted.s_right,
                    ].into_iter().nth(column).unwrap();
                    *field += if matches!(column, 5 | 7) { step_size } else { step_size * radian };
                    robot.residual(pose, &shifted)
                };
                let (residual_above, residual_below) = (residual_after(step), residual_after(-step));
                for row in 0..8 {
                    let slope = (residual_above[row] - residual_below[row]) / (2.0 * step);
                    prop_assert!((slope - k[row][column]).abs() < 1e-6 * 200.0, "K* {row} {column}");
                }
            }
        }

        #[test]
        fn the_blocks_multiply_to_the_determinant_of_k_star(
            (robot, _, solution) in any_solved(),
        ) {
            let product = solution.blocks().determinant();
            let eliminated_determinant = determinant_of(solution.passive_matrix());
            let l = robot.links;
            let scale = l.l2 * l.l3 * l.l7 * l.l8 * solution.left.d * solution.right.d;
            prop_assert!((product - eliminated_determinant).abs() < 1e-9 * scale, "{product} {eliminated_determinant}");
        }
    }

    /// The determinant by Gaussian elimination with pivoting.
    fn determinant_of(mut m: [[f64; 8]; 8]) -> f64 {
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
}
