//! The Jacobian of a five-bar and its local conditioning index, a measure of how evenly the two servos move the end
//! point in all directions.

use crate::five_bar::FiveBarPose;
use crate::vector::Vector;

/// The Jacobian of a five-bar, mm per radian: J = A^-1 B, where A (end point velocity) = B (crank rates).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobian {
    /// Column of the left crank: velocity of the end point per rate of that crank.
    pub left: Vector,
    /// Column of the right crank: velocity of the end point per rate of that crank.
    pub right: Vector,
}

impl Jacobian {
    /// det J, mm^2: the area that the end point covers per area in the plane of the crank angles.
    pub fn determinant(&self) -> f64 {
        self.left.cross(self.right)
    }

    /// The largest and the smallest singular value, mm per radian.
    pub fn singular_values(&self) -> [f64; 2] {
        let sum = self.left.length_squared() + self.right.length_squared();
        let det = self.determinant().abs();
        let max = ((sum + 2.0 * det).sqrt() + (sum - 2.0 * det).max(0.0).sqrt()) / 2.0;
        // Near a singularity, the difference of the roots would lose its digits.
        let min = if max > 0.0 { det / max } else { 0.0 };
        [max, min]
    }
}

impl FiveBarPose {
    /// The Jacobian. Each coupler transmits only the velocity along itself, so the row of the left coupler reads l2 . v
    /// = l2 . (velocity of its crank tip), where v is the velocity of the end point. Not finite at a type-2
    /// singularity, where the end point can move while both servos hold.
    pub fn jacobian(&self) -> Jacobian {
        let (left, right) = self.coupler_velocities();
        Jacobian {
            left: self.right_coupler.rotated_right() * (left / self.type2),
            right: self.left_coupler.rotated_left() * (right / self.type2),
        }
    }

    /// The local conditioning index: the ratio of the smallest to the largest singular value of the
    /// Jacobian (spectral norm). It is 0 at a singularity of either type, and 1 where the servos move
    /// the end point equally well in every direction.
    pub fn conditioning_index(&self) -> f64 {
        // The index does not depend on a common factor. Omitting 1/type2 keeps the numbers finite at a type-2
        // singularity.
        let (left, right) = self.coupler_velocities();
        let scaled_jacobian = Jacobian {
            left: self.right_coupler.rotated_right() * left,
            right: self.left_coupler.rotated_left() * right,
        };
        let [max, min] = scaled_jacobian.singular_values();
        if max > 0.0 { min / max } else { 0.0 }
    }

    /// The velocity along each coupler per rate of its crank, mm per radian: the diagonal of B.
    fn coupler_velocities(&self) -> (f64, f64) {
        (
            -self.five_bar.left_crank_length * self.type1_left(),
            self.five_bar.right_crank_length * self.type1_right(),
        )
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use crate::derivatives::ServoMotion;
    use crate::reference::{any_solved_lizard, config_with_cases};

    proptest! {
        #![proptest_config(config_with_cases(2048))]

        #[test]
        fn the_jacobian_gives_the_velocity_of_the_head(
            (_, _, solution) in any_solved_lizard(), rates in [-300.0..300.0, -300.0..300.0f64],
        ) {
            prop_assume!(solution.head.type2 > 1e-3);
            let motion = ServoMotion { rates: [rates[0], rates[1], 0.0, 0.0], ..ServoMotion::default() };
            let expected = solution.derivatives(&motion).head.rate;
            let jacobian = solution.head.jacobian();
            let computed = jacobian.left * rates[0].to_radians() + jacobian.right * rates[1].to_radians();
            prop_assert!((expected - computed).length() < 1e-9 * (1.0 + expected.length()) / solution.head.type2);
            let [max, min] = jacobian.singular_values();
            prop_assert!((min / max - solution.head.conditioning_index()).abs() < 1e-9);
            prop_assert!((max * min - jacobian.determinant().abs()).abs() < 1e-9 * max * max);
        }
    }
}
