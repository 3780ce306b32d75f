//! The faults that leave a mechanism without a position, and the messages about them.

use core::fmt;

use crate::end::End;
use crate::side::Side;

/// A mechanism of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mechanism {
    /// The five-bar of an end.
    End(End),
    /// The slider of a side.
    Side(Side),
}

impl fmt::Display for Mechanism {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::End(end) => write!(f, "{end}"),
            Self::Side(side) => write!(f, "{side} side"),
        }
    }
}

/// A fault that leaves a loop without a position, or without a unique one. All lengths are in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// An input or a result is infinite or NaN. Lengths above about 1e75 mm overflow in the
    /// computation, and lengths below about 1e-75 mm underflow.
    NotFinite,
    /// The crank tips are farther apart than both couplers together reach.
    TooFarApart {
        /// Distance between the crank tips.
        gap: f64,
        /// Largest possible distance: the sum of the couplers' lengths.
        max_gap: f64,
    },
    /// The crank tips are closer together than the couplers, of unequal length, allow.
    TooClose {
        /// Distance between the crank tips.
        gap: f64,
        /// Smallest possible distance: the difference of the couplers' lengths.
        min_gap: f64,
    },
    /// The crank tips of a five-bar coincide, so the end point can be anywhere on a circle.
    Coincident,
    /// A point is outside the ring that a crank and its coupler can reach.
    OutOfReach {
        /// True for the left crank, false for the right one, in the five-bar's own frame.
        is_left: bool,
        /// Distance of the point from the crank's shaft.
        distance: f64,
        /// Smallest distance from the shaft that crank and coupler can reach.
        min_reach: f64,
        /// Largest distance from the shaft that crank and coupler can reach.
        max_reach: f64,
    },
    /// A point lies on a shaft whose crank and coupler are equally long, so every crank angle is a solution.
    OnShaft,
    /// The arm tips of a slider coincide, so the slider has no direction.
    Collapsed,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite => f.write_str("a value is not a finite number"),
            Self::TooFarApart { gap, max_gap } => write!(
                f,
                "the crank tips are {gap:.3} mm apart, but the couplers reach only {max_gap:.3} mm"
            ),
            Self::TooClose { gap, min_gap } => write!(
                f,
                "the crank tips are {gap:.3} mm apart, but the couplers need at least {min_gap:.3} mm"
            ),
            Self::Coincident => f.write_str(
                "singular: the crank tips coincide, so the end point can be anywhere on a circle",
            ),
            Self::OutOfReach {
                is_left,
                distance,
                min_reach,
                max_reach,
            } => write!(
                f,
                "the point is {distance:.3} mm from the {} shaft, but must be between {min_reach:.3} and {max_reach:.3} mm away",
                if is_left { "left" } else { "right" }
            ),
            Self::OnShaft => f.write_str(
                "singular: the point lies on a shaft, so every crank angle is a solution",
            ),
            Self::Collapsed => f.write_str("singular: the arm tips of the slider coincide"),
        }
    }
}

impl core::error::Error for Fault {}

/// The error for a pose that the robot cannot take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfeasiblePose {
    /// The mechanism whose loop does not close.
    pub mechanism: Mechanism,
    /// The fault that keeps the loop from closing.
    pub fault: Fault,
}

impl fmt::Display for InfeasiblePose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.mechanism, self.fault)
    }
}

impl core::error::Error for InfeasiblePose {}
