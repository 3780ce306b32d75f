//! A parallelogram that carries the foot.
//!
//! Ground and coupler are equally long, and so are crank and follower; then the
//! follower stays parallel to the crank and the coupler never turns. At crank
//! angles 0 and 180 degrees all four joints lie on one line, and from there the
//! linkage may fold into an anti-parallelogram instead. The margin is the
//! distance from that.
//!
//! The paper's half-angle formulas for the follower take the root of the
//! anti-parallelogram for 0 < theta_lg < 180, have sign slips in J and L, and
//! read theta1 in H for all four legs.

use crate::angle::wrap;
use crate::real::Real;
use crate::vector::Vector;

/// Link lengths of one leg in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Between the two pivots on the chassis: lg10.
    pub ground: f64,
    /// The link that the spring drives: lg1.
    pub crank: f64,
    /// Between crank and follower: lg12.
    pub coupler: f64,
    /// The other pivoted link: lg13.
    pub follower: f64,
}

/// A leg at some crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegPose<T = f64> {
    /// theta_lg, the crank's angle, degrees as given.
    pub theta: T,
    /// Direction of the crank, and of the follower, length one.
    pub direction: Vector<T>,
    /// |sin theta_lg|: 0 at the change points.
    pub margin: T,
}

impl LegPose {
    /// theta_lg13: angle of the follower, (-180, 180] degrees.
    pub fn follower(&self) -> f64 {
        wrap(self.theta)
    }

    /// theta_lg12: angle of the coupler against the ground link, degrees;
    /// always 0 in a parallelogram.
    pub const fn coupler(&self) -> f64 {
        0.0
    }
}

impl Leg {
    /// True if opposite links are equal, which the closed form needs.
    pub fn is_parallelogram(&self) -> bool {
        self.ground == self.coupler && self.crank == self.follower
    }

    /// The leg at a crank angle in degrees.
    pub fn forward(&self, theta: f64) -> LegPose {
        self.close(theta, Vector::direction(theta))
    }

    /// The leg at a crank angle in degrees whose direction is known already.
    #[inline(always)]
    pub fn close<T: Real>(&self, theta: T, crank: Vector<T>) -> LegPose<T> {
        LegPose {
            theta,
            direction: crank,
            margin: crank.y.magnitude(),
        }
    }
}
