//! A leg: a parallelogram linkage that carries the foot.
//!
//! Ground link and coupler are equally long, and so are crank and follower. The follower therefore stays parallel to
//! the crank, and the coupler never turns. At crank angles of 0 and 180 degrees, the change points, all four joints lie
//! on one line, and the linkage may continue as an anti-parallelogram, whose coupler turns. Beyond a change point it is
//! unknown which of the two linkages the leg has become. The margin is therefore signed: positive between the change
//! points on the side on which the leg was assembled, negative beyond them.
//!
//! The paper's half-angle formulas for the follower give the anti-parallelogram for 0 < theta_lg < 180. Their J and L
//! have wrong signs, and their H contains theta1 for all four legs.

use crate::angle::wrap;
use crate::end::End;
use crate::real::Real;
use crate::vector::Vector;

/// The link lengths of a leg, all above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Length of the ground link, mm: the distance between the two pivots on the chassis, lg10.
    pub ground: f64,
    /// Length of the crank, which the strut drives, mm: lg1.
    pub crank: f64,
    /// Length of the coupler between crank and follower, mm: lg12.
    pub coupler: f64,
    /// Length of the follower, which turns on the second pivot of the chassis, mm: lg13.
    pub follower: f64,
}

/// The pose of a leg at a crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegPose<T = f64> {
    /// theta_lg: the crank's angle as given, degrees, chassis frame.
    pub theta: T,
    /// Direction of crank and follower, length one, chassis frame.
    pub direction: Vector<T>,
    /// Signed margin, -1 to 1: sin theta_lg for front legs, -sin theta_lg for hind legs. 0 at the
    /// change points, positive on the side on which the leg was assembled.
    pub margin: T,
}

impl LegPose {
    /// theta_lg13: the follower's angle, (-180, 180] degrees.
    pub fn follower_angle(&self) -> f64 {
        wrap(self.theta)
    }

    /// theta_lg12: the coupler's angle relative to the ground link, degrees; always 0 in a parallelogram.
    pub const fn coupler_angle(&self) -> f64 {
        0.0
    }
}

impl Leg {
    /// The pose of a leg at `end` for a crank angle (degrees) whose direction (length one) is
    /// already known; both in the chassis frame.
    #[inline(always)]
    pub fn pose_at<T: Real>(&self, end: End, theta: T, crank_direction: Vector<T>) -> LegPose<T> {
        LegPose {
            theta,
            direction: crank_direction,
            margin: margin(end.mirror(crank_direction)),
        }
    }
}

/// The signed margin of a leg whose crank has this direction (length one) in the frame of the leg's end.
#[inline(always)]
pub(crate) fn margin<T: Real>(crank: Vector<T>) -> T {
    crank.y
}
