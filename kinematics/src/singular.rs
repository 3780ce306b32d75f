//! Where a five-bar is singular, as curves in the plane of its crank angles.
//!
//! The paper finds singular configurations at sin(theta2 + theta3) = 0, which
//! holds in every symmetrical pose, home included. The determinant of K* is in
//! truth sin(theta3 - theta2) times lengths. Each curve below is given by the
//! left crank: with it fixed, a singular right crank is where two circles meet.

use crate::angle::wrap;
use crate::five_bar::{AssemblyMode, FiveBar};
use crate::vector::Vector;

/// A kind of singular position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularity {
    /// Type 2: the couplers lie on one line, or the crank tips coincide; the
    /// end point is loose although both servos hold.
    Couplers,
    /// Type 1: left crank and coupler lie on one line; the end point cannot move
    /// along it.
    LeftArm,
    /// Type 1 of the right arm.
    RightArm,
}

/// A singular position of a five-bar. Crank angles in (-180, 180] degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingularPose {
    /// What lines up.
    pub kind: Singularity,
    /// Left crank.
    pub theta_left: f64,
    /// Right crank.
    pub theta_right: f64,
}

impl FiveBar {
    /// Every singular position with this left crank angle (degrees), on the
    /// assembly mode that the robot is built in; at most ten.
    ///
    /// Coinciding crank tips are single points of the plane, which no crank
    /// angle but theirs finds: see [`FiveBar::coinciding_tips`].
    pub fn singular_with(&self, theta_left: f64) -> impl Iterator<Item = SingularPose> + use<> {
        let bars = *self;
        let left = Vector::direction(theta_left);
        let tip = bars.left_shaft() + left * bars.crank_left;
        let (l2, l3) = (bars.coupler_left, bars.coupler_right);
        // Type 2: the right tip at the sum or the difference of the couplers.
        let couplers = [l2 + l3, (l2 - l3).abs()]
            .into_iter()
            .filter(|reach| *reach > 0.0)
            .flat_map(move |reach| bars.right_cranks_at(tip, reach))
            .map(|theta| (Singularity::Couplers, theta));
        // Type 1 left: the end point at the stretched or the folded arm's end.
        let left_arm = [l2, -l2]
            .into_iter()
            .flat_map(move |reach| bars.right_cranks_at(tip + left * reach, l3))
            .map(|theta| (Singularity::LeftArm, theta));
        // Type 1 right: the end point on a circle about the right shaft, l4 +- l3.
        let right_arm = [bars.crank_right + l3, bars.crank_right - l3]
            .into_iter()
            .flat_map(move |reach| {
                meet(tip, l2, bars.right_shaft(), reach.abs())
                    .map(move |point| (point - bars.right_shaft()) * (1.0 / reach))
            })
            .filter(|crank| crank.is_finite())
            .map(|crank| (Singularity::RightArm, crank.angle()));
        couplers
            .chain(left_arm)
            .chain(right_arm)
            .map(move |(kind, theta_right)| SingularPose {
                kind,
                theta_left: wrap(theta_left),
                theta_right,
            })
            .filter(move |pose| bars.is_singular(pose))
    }

    /// The crank angles where both crank tips are at one point and the end point is
    /// free on a circle; needs equal couplers.
    pub fn coinciding_tips(&self) -> impl Iterator<Item = SingularPose> + use<> {
        let (left, right) = (self.left_shaft(), self.right_shaft());
        let equal = self.coupler_left == self.coupler_right;
        meet(left, self.crank_left, right, self.crank_right)
            .filter(move |_| equal)
            .map(move |tip| SingularPose {
                kind: Singularity::Couplers,
                theta_left: (tip - left).angle(),
                theta_right: (tip - right).angle(),
            })
    }

    /// Right crank angles that put the right tip at a distance from a point.
    fn right_cranks_at(&self, point: Vector, reach: f64) -> impl Iterator<Item = f64> + use<> {
        let shaft = self.right_shaft();
        meet(point, reach, shaft, self.crank_right).map(move |tip| (tip - shaft).angle())
    }

    /// A candidate's margin vanishes in the robot's own assembly mode; the
    /// other shares the circles but not the arms. A couplers' candidate may
    /// miss its closure by rounding and counts.
    fn is_singular(&self, pose: &SingularPose) -> bool {
        match self.forward_in(AssemblyMode::Ahead, pose.theta_left, pose.theta_right) {
            Err(_) => pose.kind == Singularity::Couplers,
            Ok(closed) => {
                let margin = match pose.kind {
                    Singularity::Couplers => closed.type2,
                    Singularity::LeftArm => closed.type1_left(),
                    Singularity::RightArm => closed.type1_right(),
                };
                margin.abs() < 1e-6
            }
        }
    }
}

/// Where two circles meet: none or two points.
fn meet(a: Vector, r: f64, b: Vector, s: f64) -> impl Iterator<Item = Vector> {
    let between = b - a;
    let square = between.square();
    let along = (square + (r - s) * (r + s)) / (2.0 * square);
    let rise = libm::sqrt(r * r / square - along * along);
    // No meeting, or equal centres: not a number, which ends here.
    let points = rise.is_finite().then(|| {
        let foot = a + between * along;
        let up = between.left() * rise;
        [foot + up, foot - up]
    });
    points.into_iter().flatten()
}
