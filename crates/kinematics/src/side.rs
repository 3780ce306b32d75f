//! The two sides of the robot, each with a slider between a front and a rear arm.
//!
//! An arm is fixed to its crank at a right angle, away from the robot's centre line. The arm's direction is therefore
//! the crank's, turned by +90 or -90 degrees, and the right side is the mirror image of the left one. The paper prints
//! theta16 = theta4 + 90 and theta13 = theta8 - 90, which would make the right arms point across the chassis.

use core::fmt;

use crate::real::Real;
use crate::vector::Vector;

/// One side of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The left side, between A1 and A4.
    Left,
    /// The right side, between A2 and A3.
    Right,
}

impl Side {
    /// Both sides, the left first.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];

    /// The side's name in messages: `left`, `right`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// Indices, in servo order, of the side's front and rear servo.
    pub const fn servos(self) -> [usize; 2] {
        match self {
            Self::Left => [0, 3],
            Self::Right => [1, 2],
        }
    }

    /// The sign of the side: 1 on the left, -1 on the right. The angle from a crank to its arm is
    /// this sign times +90 degrees at the front and times -90 degrees at the rear.
    pub const fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// The direction of a front arm whose crank has the direction `crank`, both in the chassis frame:
    /// theta12 = theta1 + 90, theta16 = theta4 - 90.
    #[inline(always)]
    pub fn front_arm<T: Real>(self, crank: Vector<T>) -> Vector<T> {
        match self {
            Self::Left => crank.rotated_left(),
            Self::Right => crank.rotated_right(),
        }
    }

    /// The direction of a rear arm whose crank has the direction `crank`, both in the chassis frame:
    /// theta9 = theta5 - 90, theta13 = theta8 + 90.
    #[inline(always)]
    pub fn rear_arm<T: Real>(self, crank: Vector<T>) -> Vector<T> {
        match self {
            Self::Left => crank.rotated_right(),
            Self::Right => crank.rotated_left(),
        }
    }

    /// Picks the values of the side's front and rear servos from four values in servo order.
    #[inline(always)]
    pub fn pick<T: Copy>(self, values: [T; 4]) -> [T; 2] {
        let [front, rear] = self.servos();
        [values[front], values[rear]]
    }
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::end::End;

    #[test]
    fn ends_and_sides_list_the_same_servos() {
        for (end, row) in [(End::Head, 0), (End::Tail, 1)] {
            for (side, column) in [(Side::Left, 0), (Side::Right, 1)] {
                assert_eq!(end.servos()[column], side.servos()[row]);
            }
        }
        assert_eq!(Side::Right.pick(["A1", "A2", "A3", "A4"]), ["A2", "A3"]);
    }

    #[test]
    fn every_arm_points_outward_when_its_crank_is_parallel_to_the_centre_line() {
        let (forward_crank, backward_crank) = (Vector::new(0.0, 1.0), Vector::new(0.0, -1.0));
        for side in Side::ALL {
            let outward_arm = Vector::new(-side.sign(), 0.0);
            assert_eq!(side.front_arm(forward_crank), outward_arm);
            assert_eq!(side.rear_arm(backward_crank), outward_arm);
        }
    }
}
