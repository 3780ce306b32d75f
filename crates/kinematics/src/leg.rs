//! A parallelogram that carries the foot.
//!
//! Ground and coupler are equally long, and so are crank and follower; then the follower
//! stays parallel to the crank and the coupler never turns. At crank angles 0 and 180
//! degrees, the change points, all four joints lie on one line, and from there the
//! linkage may continue as an anti-parallelogram, whose coupler turns. After a change
//! point the branch is unknown, so the margin is signed: positive between the change points
//! on the side where the leg was assembled, negative beyond them.
//!
//! The paper's half-angle formulas for the follower take the root of the
//! anti-parallelogram for 0 < theta_lg < 180, have wrong signs in J and L, and have
//! theta1 in H for all four legs.

use crate::angle::wrap;
use crate::end::End;
use crate::real::Real;
use crate::vector::Vector;

/// Link lengths of one leg in mm, all above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Distance between the two pivots on the chassis, mm: lg10.
    pub ground: f64,
    /// The link that the strut drives, mm: lg1.
    pub crank: f64,
    /// The link between crank and follower, mm: lg12.
    pub coupler: f64,
    /// The link on the second pivot of the chassis, mm: lg13.
    pub follower: f64,
}

/// A leg at some crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegPose<T = f64> {
    /// theta_lg, the crank's angle, degrees as given, chassis frame.
    pub theta: T,
    /// Direction of the crank, and of the follower, length one, chassis frame.
    pub direction: Vector<T>,
    /// The signed margin, -1 to 1: sin theta_lg in the frame of the leg's end,
    /// so sin theta_lg in front and -sin theta_lg behind. 0 at the change
    /// points, positive on the side where the leg was assembled.
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
    /// The leg of an end at a crank angle in degrees, chassis frame.
    pub fn forward(&self, end: End, theta: f64) -> LegPose {
        self.shape(end, theta, Vector::direction(theta))
    }

    /// The leg of an end at a crank angle in degrees whose direction is known
    /// already; both in the chassis frame.
    #[inline(always)]
    pub fn shape<T: Real>(&self, end: End, theta: T, crank: Vector<T>) -> LegPose<T> {
        LegPose {
            theta,
            direction: crank,
            margin: margin(end.mirror(crank)),
        }
    }
}

/// The signed margin of a leg whose crank has this direction (length one) in the
/// frame of its end.
#[inline(always)]
pub(crate) fn margin<T: Real>(crank: Vector<T>) -> T {
    crank.y
}
