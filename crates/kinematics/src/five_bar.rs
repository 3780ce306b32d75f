//! The RRRRR five-bar: two cranks, each driven by a motor, and two couplers that are joined at the end point.
//!
//! Given the crank tips, the end point is an intersection of two circles; given the end point, each crank tip is an
//! intersection of two circles. Forward and inverse kinematics both use the area of a triangle in the factored form of
//! Heron's formula, which loses no digits if the triangle is flat.
//!
//! The paper solves R1 + R2 = R0 + R4 + R3 with the tangents of half angles. Its theta3 is correct, but the formula is
//! 0/0 if the crank tips coincide, and loses digits if the paper's A is 0. Its theta2 (D, E, F, K4) has three wrong
//! signs.

mod inverse;

pub use inverse::{Elbow, InverseSolution, WorkingMode};

use crate::fault::Fault;
use crate::real::{Lanes, Real};
use crate::vector::Vector;

/// Gap between the crank tips, mm, below which the end point counts as undefined: rounding errors alone move it by more
/// than 0.1 mm.
const COINCIDENCE_GAP: f64 = 1e-12;

/// The links of a five-bar; all but the base must be longer than 0. The five-bar's own frame has its origin in the
/// middle of the base, x from the left shaft to the right one, and y away from the chassis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiveBar {
    /// Distance between the shafts, mm: l0, l5. May be 0.
    pub base: f64,
    /// Left crank, mm: l1, l6.
    pub left_crank_length: f64,
    /// Left coupler, mm: l2, l7.
    pub left_coupler_length: f64,
    /// Right coupler, mm: l3, l8.
    pub right_coupler_length: f64,
    /// Right crank, mm: l4, l9.
    pub right_crank_length: f64,
}

/// The side of the line through the crank tips on which the end point lies. A mechanism cannot
/// change its assembly mode without passing through a type-2 singularity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AssemblyMode {
    /// End point to the left of the line from the left crank tip to the right one; this side is ahead as long as the
    /// cranks are not crossed. The robot is built in this mode. In the paper's theta3, the root with -sqrt gives it.
    Ahead,
    /// End point to the right of the line from the left crank tip to the right one.
    Behind,
}

/// A pose of a five-bar whose loop closes, in the five-bar's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiveBarPose<T = f64> {
    /// Links of the five-bar.
    pub five_bar: FiveBar,
    /// Direction of the left crank, length one.
    pub left_crank: Vector<T>,
    /// Direction of the right crank, length one.
    pub right_crank: Vector<T>,
    /// Tip of the left crank, mm.
    pub left_tip: Vector<T>,
    /// Tip of the right crank, mm.
    pub right_tip: Vector<T>,
    /// Direction of the left coupler (theta2), length one.
    pub left_coupler: Vector<T>,
    /// Direction of the right coupler (theta3), length one.
    pub right_coupler: Vector<T>,
    /// The end point, mm.
    pub end_point: Vector<T>,
    /// Vector from the left crank tip to the right one, mm: (K2, K1) in the paper. The cranks are
    /// crossed if its x is not above 0.
    pub gap: Vector<T>,
    /// Type-2 margin sin(theta3 - theta2), -1 to 1: 0 if the couplers line up, so that the end
    /// point can move although both servos hold. Positive in [`AssemblyMode::Ahead`].
    pub type2: T,
}

impl FiveBarPose {
    /// theta2 (for the tail theta6, mirrored): angle of the left coupler, degrees.
    #[inline]
    pub fn theta_left_coupler(&self) -> f64 {
        self.left_coupler.angle()
    }

    /// theta3 (for the tail theta7, mirrored): angle of the right coupler, degrees.
    #[inline]
    pub fn theta_right_coupler(&self) -> f64 {
        self.right_coupler.angle()
    }

    /// The smallest of the type-2 margin and the two type-1 margins; the margins of the legs are not included.
    pub fn margin(&self) -> f64 {
        self.type2.min(self.type1_left()).min(self.type1_right())
    }
}

impl<T: Real> FiveBarPose<T> {
    /// Type-1 margin of the left arm, sin(theta1 - theta2), -1 to 1: 0 if crank and coupler line
    /// up, so that the end point cannot move along them; positive for an outward elbow.
    #[inline(always)]
    pub fn type1_left(&self) -> T {
        self.left_coupler.cross(self.left_crank)
    }

    /// Type-1 margin of the right arm, sin(theta3 - theta4), -1 to 1: 0 if crank and coupler line up; positive for an
    /// outward elbow.
    #[inline(always)]
    pub fn type1_right(&self) -> T {
        self.right_crank.cross(self.right_coupler)
    }

    /// A sum that is finite only if every number of the pose is finite.
    #[inline(always)]
    fn finiteness_probe(&self) -> T {
        self.end_point.x + self.end_point.y + self.type2 + self.type1_left() + self.type1_right()
    }
}

impl FiveBar {
    /// Creates a five-bar from its lengths in mm: base, left crank, left coupler, right coupler, right crank.
    pub const fn new(lengths: [f64; 5]) -> Self {
        Self {
            base: lengths[0],
            left_crank_length: lengths[1],
            left_coupler_length: lengths[2],
            right_coupler_length: lengths[3],
            right_crank_length: lengths[4],
        }
    }

    /// Shaft of the left crank, mm.
    #[inline]
    pub fn left_shaft(&self) -> Vector {
        Vector::new(-self.base / 2.0, 0.0)
    }

    /// Shaft of the right crank, mm.
    #[inline]
    pub fn right_shaft(&self) -> Vector {
        Vector::new(self.base / 2.0, 0.0)
    }

    /// The pose at two crank angles (degrees, own frame), in the assembly mode in which the robot is
    /// built. Loops of the robot's size close within 1e-12 mm.
    ///
    /// # Errors
    /// Returns [`Fault::TooFarApart`] or [`Fault::TooClose`] if the couplers cannot meet, [`Fault::Coincident`] if the
    /// crank tips coincide, [`Fault::NotFinite`] if the input is not finite or overflows.
    ///
    /// ```
    /// let head = lizard_kinematics::FiveBar::new([20.0, 30.0, 50.0, 50.0, 30.0]);
    /// let pose = head.forward(90.0, 90.0).unwrap();
    /// assert!((pose.end_point.y - 30.0 - 2400.0f64.sqrt()).abs() < 1e-12);
    /// ```
    pub fn forward(&self, theta_left: f64, theta_right: f64) -> Result<FiveBarPose, Fault> {
        self.forward_in_mode(AssemblyMode::Ahead, theta_left, theta_right)
    }

    /// The pose at two crank angles (degrees, own frame), in either assembly mode.
    ///
    /// # Errors
    /// Fails as [`FiveBar::forward`] does.
    pub fn forward_in_mode(
        &self,
        mode: AssemblyMode,
        theta_left: f64,
        theta_right: f64,
    ) -> Result<FiveBarPose, Fault> {
        let [left, right] = [theta_left, theta_right].map(Vector::from_angle);
        self.close(mode, left, right)
    }

    /// The pose at two crank directions of length one; like [`FiveBar::forward_in_mode`], but without
    /// computing sines and cosines.
    ///
    /// # Errors
    /// Fails as [`FiveBar::forward`] does.
    #[inline]
    pub fn close(
        &self,
        mode: AssemblyMode,
        left: Vector,
        right: Vector,
    ) -> Result<FiveBarPose, Fault> {
        let pose = self.pose_unchecked(mode, left, right);
        self.check_pose(&pose)?;
        Ok(pose)
    }

    /// Checks that the loop of a pose closes.
    #[inline]
    pub(crate) fn check_pose(&self, pose: &FiveBarPose) -> Result<(), Fault> {
        self.check_closure(pose.gap.length(), pose.finiteness_probe())
    }

    /// Returns, for each lane, true if the loop closes. For the cranks of a lane with an open loop, [`FiveBar::close`]
    /// returns the fault.
    #[inline(always)]
    pub fn are_loops_closed<const N: usize>(&self, pose: &FiveBarPose<Lanes<N>>) -> [bool; N] {
        let (Lanes(d), Lanes(probe)) = (pose.gap.length(), pose.finiteness_probe());
        let mut is_closed = [false; N];
        for i in 0..N {
            is_closed[i] = self.check_closure(d[i], probe[i]).is_ok();
        }
        is_closed
    }

    /// Checks a pose, given the distance `d` between its crank tips and its [`FiveBarPose::finiteness_probe`].
    #[inline(always)]
    fn check_closure(&self, d: f64, probe: f64) -> Result<(), Fault> {
        let (l2, l3) = (self.left_coupler_length, self.right_coupler_length);
        let (min_gap, max_gap) = ((l2 - l3).abs(), l2 + l3);
        if !d.is_finite() || !max_gap.is_finite() {
            Err(Fault::NotFinite)
        } else if d > max_gap {
            Err(Fault::TooFarApart { gap: d, max_gap })
        } else if d < min_gap {
            Err(Fault::TooClose { gap: d, min_gap })
        } else if d < COINCIDENCE_GAP {
            Err(Fault::Coincident)
        } else if !probe.is_finite() {
            Err(Fault::NotFinite)
        } else {
            Ok(())
        }
    }

    /// The pose at crank directions of length one, without a check that the loop closes. The pose of an open loop (see
    /// [`FiveBar::are_loops_closed`]) is meaningless. The compiler leaves out the parts that the caller does not use.
    #[inline(always)]
    pub fn pose_unchecked<T: Real>(
        &self,
        mode: AssemblyMode,
        left: Vector<T>,
        right: Vector<T>,
    ) -> FiveBarPose<T> {
        let left_tip = Vector::constant(self.left_shaft()) + left * self.left_crank_length;
        let right_tip = Vector::constant(self.right_shaft()) + right * self.right_crank_length;
        let gap = right_tip - left_tip;
        let gap_squared = gap.length_squared();
        let (l2, l3) = (self.left_coupler_length, self.right_coupler_length);
        let area = match mode {
            AssemblyMode::Ahead => double_area(l2, l3, gap_squared.sqrt_or_zero()),
            AssemblyMode::Behind => -double_area(l2, l3, gap_squared.sqrt_or_zero()),
        };
        // The end point relative to the left tip: `foot` is its coordinate along the gap, relative to the gap's length;
        // `rise` is its component perpendicular to the gap.
        let foot = (gap_squared + T::constant((l2 - l3) * (l2 + l3))) / (gap_squared * 2.0);
        let rise = gap.rotated_left().scaled(area / gap_squared);
        let from_left_tip = gap.scaled(foot) + rise;
        let from_right_tip = gap.scaled(foot - T::constant(1.0)) + rise;
        FiveBarPose {
            five_bar: *self,
            left_crank: left,
            right_crank: right,
            left_tip,
            right_tip,
            left_coupler: from_left_tip * (1.0 / l2),
            right_coupler: from_right_tip * (1.0 / l3),
            end_point: left_tip + from_left_tip,
            gap,
            type2: area * (1.0 / (l2 * l3)),
        }
    }
}

/// Twice the area of a triangle with these sides, by Heron's formula in factored form.
#[inline(always)]
fn double_area<T: Real>(a: f64, b: f64, c: T) -> T {
    let (sum, difference) = (T::constant(a + b), T::constant(a - b));
    let product = (sum + c) * (sum - c) * (c + difference) * (c - difference);
    product.sqrt_or_zero() * 0.5
}

#[cfg(test)]
mod tests;
