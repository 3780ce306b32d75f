//! The eight loop equations of the body and their Jacobians K and K*.
//!
//! K holds the derivatives of the equations with respect to the active joints, K* those with respect to the passive
//! joints. The paper prints K as 8x8 and takes its determinant, but there are only four active joints, so K is 8x4 and
//! has no determinant. K* is 8x8 and block diagonal; its determinant is the product of four block determinants. The
//! rows are the x and y components of the head, tail, left and right loops, mm, all in the chassis frame with
//! counter-clockwise angles; therefore several entries and their printed forms have opposite signs.

use crate::end::End;
use crate::lizard::{Lizard, Solution};
use crate::side::Side;
use crate::vector::Vector;

/// The values of the passive joints, chassis frame. The direction phi and the travel s of a slider
/// replace the paper's theta10 and theta11 (on the right: theta14 and theta15).
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
    pub fn passive_joints(&self) -> PassiveJoints {
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

    /// K: derivatives of the loop equations with respect to theta1, theta4, theta8, theta5, mm per radian.
    pub fn active_matrix(&self) -> [[f64; 4]; 8] {
        let mut k = [[0.0; 4]; 8];
        for (row, end) in LOOP_ROWS.into_iter().zip(End::ALL) {
            let ([left, right], pose) = (end.servos(), self.end(end));
            let five_bar = &pose.five_bar;
            let crank = end.mirror(pose.left_crank) * five_bar.left_crank_length;
            put_derivative(&mut k, row, left, crank.rotated_left());
            let crank = end.mirror(pose.right_crank) * five_bar.right_crank_length;
            put_derivative(&mut k, row, right, -crank.rotated_left());
        }
        for (row, side) in LOOP_ROWS.into_iter().skip(2).zip(Side::ALL) {
            let ([front, rear], pose) = (side.servos(), self.side(side));
            put_derivative(&mut k, row, front, pose.front_arm().rotated_left());
            put_derivative(&mut k, row, rear, -pose.rear_tip.rotated_left());
        }
        k
    }

    /// K*: derivatives of the loop equations with respect to theta2, theta3, theta6, theta7, phi and s of the left
    /// slider, phi and s of the right slider, mm per radian and mm per mm.
    pub fn passive_matrix(&self) -> [[f64; 8]; 8] {
        let mut k = [[0.0; 8]; 8];
        for (row, end) in LOOP_ROWS.into_iter().zip(End::ALL) {
            let ([left, right], five_bar) = (self.coupler_directions(end), &self.end(end).five_bar);
            let coupler = left * five_bar.left_coupler_length;
            put_derivative(&mut k, row, row, coupler.rotated_left());
            let coupler = right * five_bar.right_coupler_length;
            put_derivative(&mut k, row, row + 1, -coupler.rotated_left());
        }
        for (row, side) in LOOP_ROWS.into_iter().skip(2).zip(Side::ALL) {
            let slider = self.side(side);
            put_derivative(&mut k, row, row, -slider.span.rotated_left());
            put_derivative(&mut k, row, row + 1, slider.span * (-1.0 / slider.d));
        }
        k
    }

    /// The determinants of the blocks of K*, whose product is det K*.
    pub fn block_determinants(&self) -> BlockDeterminants {
        let five_bar_determinant = |end: End| {
            let pose = self.end(end);
            let lengths = pose.five_bar.left_coupler_length * pose.five_bar.right_coupler_length;
            // Mirroring changes the sign of the sine.
            -end.sign() * lengths * pose.type2
        };
        BlockDeterminants {
            head: five_bar_determinant(End::Head),
            tail: five_bar_determinant(End::Tail),
            left: -self.left.d,
            right: -self.right.d,
        }
    }
}

impl Lizard {
    /// The residuals of the eight loop equations for any values of the joints, mm; zero at a
    /// solution. The active angles are in degrees and in servo order.
    pub fn residuals(&self, active: [f64; 4], passive: &PassiveJoints) -> [f64; 8] {
        let (shafts, cis) = (self.shafts(), Vector::from_angle);
        let couplers = [
            [passive.theta2, passive.theta3],
            [passive.theta6, passive.theta7],
        ];
        let sliders = [
            (passive.phi_left, passive.s_left),
            (passive.phi_right, passive.s_right),
        ];
        let mut residual = [0.0; 8];
        let mut put_residual = |row: usize, gap: Vector| {
            (residual[row], residual[row + 1]) = (gap.x, gap.y);
        };
        for ((row, end), theta) in LOOP_ROWS.into_iter().zip(End::ALL).zip(couplers) {
            let ([left, right], five_bar) = (end.servos(), self.end(end));
            let gap = shafts[left]
                + cis(active[left]) * five_bar.left_crank_length
                + cis(theta[0]) * five_bar.left_coupler_length
                - (shafts[right]
                    + cis(active[right]) * five_bar.right_crank_length
                    + cis(theta[1]) * five_bar.right_coupler_length);
            put_residual(row, gap);
        }
        for ((row, side), (phi, s)) in LOOP_ROWS.into_iter().skip(2).zip(Side::ALL).zip(sliders) {
            let ([front, rear], slider) = (side.servos(), self.side(side));
            let right_angle = 90.0 * side.sign();
            let gap = shafts[front] + cis(active[front] + right_angle) * slider.front_arm
                - (shafts[rear] + cis(active[rear] - right_angle) * slider.rear_arm)
                - cis(phi) * (slider.nominal_length + s);
            put_residual(row, gap);
        }
        residual
    }
}

/// The first row of each loop in K and K*: head, tail, left, right. In K* the loops' first
/// columns have the same numbers.
const LOOP_ROWS: [usize; 4] = [0, 2, 4, 6];

/// Writes the derivative of a loop with respect to a joint into the loop's two rows, in the joint's column.
fn put_derivative<const N: usize>(
    matrix: &mut [[f64; N]; 8],
    row: usize,
    column: usize,
    entry: Vector,
) {
    matrix[row][column] = entry.x;
    matrix[row + 1][column] = entry.y;
}

#[cfg(test)]
#[allow(clippy::needless_range_loop)] // Matrices read best with their indices.
mod tests {
    use proptest::prelude::*;

    use crate::reference::{any_solved_lizard, config_with_cases};

    proptest! {
        #![proptest_config(config_with_cases(2048))]

        #[test]
        fn k_and_k_star_are_the_derivatives_of_the_loop_equations(
            (robot, pose, solution) in any_solved_lizard(),
        ) {
            let passive = solution.passive_joints();
            compare_with_difference_quotients("K", solution.active_matrix(), |column, step| {
                let mut active = pose;
                active[column] += step.to_degrees();
                robot.residuals(active, &passive)
            })?;
            compare_with_difference_quotients("K*", solution.passive_matrix(), |column, step| {
                let mut shifted = passive;
                let field = [
                    &mut shifted.theta2, &mut shifted.theta3, &mut shifted.theta6, &mut shifted.theta7,
                    &mut shifted.phi_left, &mut shifted.s_left, &mut shifted.phi_right, &mut shifted.s_right,
                ].into_iter().nth(column).unwrap();
                *field += if matches!(column, 5 | 7) { step } else { step.to_degrees() };
                robot.residuals(pose, &shifted)
            })?;
        }

        #[test]
        fn the_product_of_the_block_determinants_is_the_determinant_of_k_star(
            (robot, _, solution) in any_solved_lizard(),
        ) {
            let product = solution.block_determinants().determinant();
            let determinant = compute_determinant(solution.passive_matrix());
            let l = robot.links;
            let scale = l.l2 * l.l3 * l.l7 * l.l8 * solution.left.d * solution.right.d;
            prop_assert!((product - determinant).abs() < 1e-9 * scale, "product {product}, determinant {determinant}");
        }
    }

    /// Compares a matrix with the difference quotients of the residuals of the loop equations. `residuals_after`
    /// returns the residuals after a step of the joint of a column, rad or mm.
    fn compare_with_difference_quotients<const N: usize>(
        name: &str,
        matrix: [[f64; N]; 8],
        residuals_after: impl Fn(usize, f64) -> [f64; 8],
    ) -> Result<(), TestCaseError> {
        const STEP: f64 = 1e-4;
        for column in 0..N {
            let [above, below] = [STEP, -STEP].map(|step| residuals_after(column, step));
            for row in 0..8 {
                let slope = (above[row] - below[row]) / (2.0 * STEP);
                let is_near = (slope - matrix[row][column]).abs() < 1e-6 * 200.0;
                prop_assert!(is_near, "{name}[{row}][{column}] is not {slope}");
            }
        }
        Ok(())
    }

    /// Computes the determinant by Gaussian elimination with pivoting.
    fn compute_determinant(mut m: [[f64; 8]; 8]) -> f64 {
        let mut product = 1.0;
        for i in 0..8 {
            let pivot = (i..8).max_by(|&a, &b| m[a][i].abs().total_cmp(&m[b][i].abs()));
            let pivot = pivot.unwrap();
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
