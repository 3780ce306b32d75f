//! The reasons why a position does not exist, as the messages that the user sees.

use core::fmt;

use crate::end::End;
use crate::side::Side;

/// A mechanism of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The five-bar of an end.
    End(End),
    /// The slider of a side.
    Side(Side),
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::End(end) => write!(f, "{end}"),
            Self::Side(side) => write!(f, "{side} side"),
        }
    }
}

/// A reason why one loop has no position, or no unique one. Lengths in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// An input or a result is infinite or not a number. Lengths above about 1e75 mm or
    /// below 1e-75 mm overflow in the computation.
    NotFinite,
    /// The crank tips are further apart than both couplers reach.
    TooFarApart {
        /// Distance between the crank tips.
        gap: f64,
        /// Sum of the couplers.
        reach: f64,
    },
    /// The crank tips are closer than the couplers differ in length.
    TooClose {
        /// Distance between the crank tips.
        gap: f64,
        /// Difference of the couplers.
        least: f64,
    },
    /// The crank tips coincide (d = 0): the end point can be anywhere on a
    /// circle.
    Coincident,
    /// A point is outside the ring that one crank and its coupler reach.
    OutOfReach {
        /// True for the left crank, seen along the five-bar's own y axis.
        is_left: bool,
        /// Distance of the point from that crank's shaft.
        distance: f64,
        /// Least distance that the crank and its coupler reach.
        least: f64,
        /// Greatest distance that the crank and its coupler reach.
        most: f64,
    },
    /// A point lies on a shaft whose crank and coupler are equally long, so every crank
    /// angle is a solution.
    OnShaft,
    /// The arm tips of a slider coincide, so the slider has no direction.
    Collapsed,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite => f.write_str("a value is not a finite number"),
            Self::TooFarApart { gap, reach } => write!(
                f,
                "the crank tips are {gap:.3} mm apart, the couplers reach {reach:.3} mm"
            ),
            Self::TooClose { gap, least } => write!(
                f,
                "the crank tips are {gap:.3} mm apart, the couplers need {least:.3} mm"
            ),
            Self::Coincident => {
                f.write_str("singular: the crank tips coincide, the end point is free on a circle")
            }
            Self::OutOfReach {
                is_left,
                distance,
                least,
                most,
            } => write!(
                f,
                "the point is {distance:.3} mm from the {} shaft, which reaches {least:.3} to {most:.3} mm",
                if is_left { "left" } else { "right" }
            ),
            Self::OnShaft => {
                f.write_str("singular: the point lies on a shaft, any crank angle will do")
            }
            Self::Collapsed => f.write_str("singular: the arm tips of the slider coincide"),
        }
    }
}

impl core::error::Error for Fault {}

/// A pose that the robot cannot take, with the mechanism and the reason.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Infeasible {
    /// The mechanism that does not close.
    pub part: Part,
    /// The reason.
    pub fault: Fault,
}

impl fmt::Display for Infeasible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.part, self.fault)
    }
}

impl core::error::Error for Infeasible {}
