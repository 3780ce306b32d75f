//! The Jacobian of a five-bar and its local conditioning index, which measures how evenly
//! the two servos steer the end point.

use crate::five_bar::FiveBarPose;
use crate::vector::Vector;

/// Velocity of the end point for each servo's rate, mm per radian: J = A^-1 B with
/// A (end point velocity) = B (crank rates).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobian {
    /// Displacement of the end point per radian of the left crank, mm.
    pub left: Vector,
    /// Displacement of the end point per radian of the right crank, mm.
    pub right: Vector,
}

impl Jacobian {
    /// det J, mm^2: end point area swept per unit of crank area.
    pub fn determinant(&self) -> f64 {
        self.left.cross(self.right)
    }

    /// Largest and smallest singular value, mm per radian.
    pub fn singular_values(&self) -> [f64; 2] {
        let (sum, det) = (
            self.left.length_squared() + self.right.length_squared(),
            self.determinant().abs(),
        );
        let largest = ((sum + 2.0 * det).sqrt() + (sum - 2.0 * det).max(0.0).sqrt()) / 2.0;
        // The difference of the roots would cancel near a singularity.
        let smallest = if largest > 0.0 { det / largest } else { 0.0 };
        [largest, smallest]
    }
}

impl FiveBarPose {
    /// The Jacobian. Each coupler transmits only the velocity along itself, so the row of
    /// the left coupler reads l2 . v = l2 . (velocity of its crank tip). Not finite at a
    /// type-2 singularity, where the end point is loose.
    pub fn jacobian(&self) -> Jacobian {
        let (left, right) = self.coupler_velocities();
        Jacobian {
            left: self.right_coupler.rotated_right() * (left / self.type2),
            right: self.left_coupler.rotated_left() * (right / self.type2),
        }
    }

    /// Local conditioning index: smallest over largest singular value of the
    /// Jacobian (spectral norm), 0 at a singularity of either type, 1 where the
    /// servos steer the end point equally well in every direction.
    pub fn lci(&self) -> f64 {
        // The index has no scale, so the factor 1/type2 is left out and nothing
        // blows up near the type-2 singularity.
        let (left, right) = self.coupler_velocities();
        let scaled_jacobian = Jacobian {
            left: self.right_coupler.rotated_right() * left,
            right: self.left_coupler.rotated_left() * right,
        };
        let [largest, smallest] = scaled_jacobian.singular_values();
        if largest > 0.0 {
            smallest / largest
        } else {
            0.0
        }
    }

    /// Velocity along each coupler per rate of its crank, mm per radian: the
    /// diagonal of B.
    fn coupler_velocities(&self) -> (f64, f64) {
        (
            -self.bars.crank_left * self.type1_left(),
            self.bars.crank_right * self.type1_right(),
        )
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use crate::derivatives::Drive;
    use crate::reference::{any_solved, cases};

    proptest! {
        #![proptest_config(cases(2048))]

        #[test]
        fn the_jacobian_moves_the_head_as_the_rates_do(
            (_, _, solution) in any_solved(), rate in [-300.0..300.0, -300.0..300.0f64],
        ) {
            prop_assume!(solution.head.type2 > 1e-3);
            let drive = Drive { rate: [rate[0], rate[1], 0.0, 0.0], ..Drive::default() };
            let expected = solution.derivatives(&drive).head.rate;
            let j = solution.head.jacobian();
            let computed = j.left * rate[0].to_radians() + j.right * rate[1].to_radians();
            prop_assert!((expected - computed).length() < 1e-9 * (1.0 + expected.length()) / solution.head.type2);
            let [largest, smallest] = j.singular_values();
            prop_assert!((smallest / largest - solution.head.lci()).abs() < 1e-9);
            prop_assert!((largest * smallest - j.determinant().abs()).abs() < 1e-9 * largest * largest);
        }
    }
}
