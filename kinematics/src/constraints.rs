//! The eight loop equations of the body and their Jacobians K and K*.
//!
//! The paper prints K as 8x8 and takes its determinant; there are four active
//! rates, so K is 8x4 and has none. K* is 8x8 and block diagonal, and its
//! determinant is the product of four block determinants. Rows are head x, y,
//! tail x, y, left x, y, right x, y in mm, all in the chassis frame with
//! counter-clockwise angles, which changes signs of several printed entries.

use crate::lizard::{Lizard, Solution};
use crate::real::Real;
use crate::vector::Vector;

/// The joints that follow: angles in degrees, travel in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // The paper's symbols; phi and s replace theta10, theta11.
pub struct Passive<T = f64> {
    pub theta2: T,
    pub theta3: T,
    pub theta6: T,
    pub theta7: T,
    pub phi_left: T,
    pub s_left: T,
    pub phi_right: T,
    pub s_right: T,
}

/// Determinants of the four diagonal blocks of K*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocks {
    /// l2 l3 sin(theta2 - theta3), mm^2.
    pub head: f64,
    /// l7 l8 sin(theta6 - theta7), mm^2.
    pub tail: f64,
    /// -d of the left slider, mm.
    pub left: f64,
    /// -d of the right slider, mm.
    pub right: f64,
}

impl Blocks {
    /// det K*, mm^6: their product.
    pub fn determinant(&self) -> f64 {
        self.head * self.tail * self.left * self.right
    }
}

impl<T: Real> Solution<T> {
    /// The passive joints of this solution; all six angles at once, which is
    /// faster than one by one, and the same bits.
    #[inline(always)]
    pub fn passive(&self) -> Passive<T> {
        let (head, tail) = (&self.head, &self.tail);
        let along = [
            head.left_coupler,
            head.right_coupler,
            tail.left_coupler.mirrored(),
            tail.right_coupler.mirrored(),
            self.left.span,
            self.right.span,
        ];
        let (mut x, mut y) = ([along[0].x; 6], [along[0].y; 6]);
        for i in 1..6 {
            (x[i], y[i]) = (along[i].x, along[i].y);
        }
        let [theta2, theta3, theta6, theta7, phi_left, phi_right] = T::atan2_each(y, x);
        Passive {
            theta2,
            theta3,
            theta6,
            theta7,
            phi_left,
            s_left: self.left.s,
            phi_right,
            s_right: self.right.s,
        }
    }
}

impl Solution {
    /// K: derivatives of the loop equations by theta1, theta4, theta8, theta5,
    /// mm per radian. 8x4.
    pub fn active_matrix(&self) -> [[f64; 4]; 8] {
        let [r1, r4] = [
            self.head.left * self.head.bars.crank_left,
            self.head.right * self.head.bars.crank_right,
        ];
        let [r6, r9] = [
            self.tail.left.mirrored() * self.tail.bars.crank_left,
            self.tail.right.mirrored() * self.tail.bars.crank_right,
        ];
        let mut k = [[0.0; 4]; 8];
        put(&mut k, 0, 0, r1.left());
        put(&mut k, 0, 1, -r4.left());
        put(&mut k, 2, 3, r6.left());
        put(&mut k, 2, 2, -r9.left());
        put(&mut k, 4, 0, self.left.front_arm().left());
        put(&mut k, 4, 3, -self.left.rear_tip.left());
        put(&mut k, 6, 1, self.right.front_arm().left());
        put(&mut k, 6, 2, -self.right.rear_tip.left());
        k
    }

    /// K*: derivatives by theta2, theta3, theta6, theta7, phi and s left, phi
    /// and s right, mm per radian and mm per mm. 8x8.
    pub fn passive_matrix(&self) -> [[f64; 8]; 8] {
        let [r2, r3] = [
            self.head.left_coupler * self.head.bars.coupler_left,
            self.head.right_coupler * self.head.bars.coupler_right,
        ];
        let [r7, r8] = [
            self.tail.left_coupler.mirrored() * self.tail.bars.coupler_left,
            self.tail.right_coupler.mirrored() * self.tail.bars.coupler_right,
        ];
        let mut k = [[0.0; 8]; 8];
        put(&mut k, 0, 0, r2.left());
        put(&mut k, 0, 1, -r3.left());
        put(&mut k, 2, 2, r7.left());
        put(&mut k, 2, 3, -r8.left());
        for (at, slider) in [(4, &self.left), (6, &self.right)] {
            put(&mut k, at, at, -slider.span.left());
            put(&mut k, at, at + 1, slider.span * (-1.0 / slider.d));
        }
        k
    }

    /// The factors of det K*.
    pub fn blocks(&self) -> Blocks {
        let (head, tail) = (&self.head.bars, &self.tail.bars);
        Blocks {
            head: -head.coupler_left * head.coupler_right * self.head.type2,
            // Mirroring turns the sign of the sine.
            tail: tail.coupler_left * tail.coupler_right * self.tail.type2,
            left: -self.left.d,
            right: -self.right.d,
        }
    }
}

impl Lizard {
    /// By how much the eight loop equations miss for any values of the joints,
    /// mm: active angles in servo order. Zero at a solution.
    pub fn residual(&self, active: [f64; 4], passive: &Passive) -> [f64; 8] {
        let l = &self.links;
        let [t1, t4, t8, t5] = active;
        let [a1, a2, a3, a4] = self.shafts();
        let cis = Vector::direction;
        let head = a1 + cis(t1) * l.l1 + cis(passive.theta2) * l.l2
            - (a2 + cis(t4) * l.l4 + cis(passive.theta3) * l.l3);
        let tail = a4 + cis(t5) * l.l6 + cis(passive.theta6) * l.l7
            - (a3 + cis(t8) * l.l9 + cis(passive.theta7) * l.l8);
        let left = a1 + cis(t1 + 90.0) * l.l14
            - (a4 + cis(t5 - 90.0) * l.l11)
            - cis(passive.phi_left) * (l.l12 + l.l13 + passive.s_left);
        let right = a2 + cis(t4 - 90.0) * l.l19
            - (a3 + cis(t8 + 90.0) * l.l16)
            - cis(passive.phi_right) * (l.l17 + l.l18 + passive.s_right);
        [
            head.x, head.y, tail.x, tail.y, left.x, left.y, right.x, right.y,
        ]
    }
}

/// A column pair: the x and y rows of one loop.
fn put<const N: usize>(matrix: &mut [[f64; N]; 8], row: usize, column: usize, entry: Vector) {
    matrix[row][column] = entry.x;
    matrix[row + 1][column] = entry.y;
}
