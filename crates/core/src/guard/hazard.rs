//! What is wrong with a pose, and by how much: the guard's reason.

use crate::numbers::part::{End, Servo, Side};
use crate::numbers::units::Sine;

/// A margin of a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// From 3 on, since no hazard at all has to be zero: see `Main::new`.
#[repr(u8)]
pub enum Margin {
    /// Between the two couplers of an end.
    Type2(End) = 3,
    /// Between the crank on a servo and its coupler, negative where the elbow is
    /// bent inwards.
    Type1(Servo),
    /// Of the parallelogram leg of a servo, negative beyond a change point.
    Leg(Servo),
}

impl Margin {
    /// False for a value that stands for no value: an end whose couplers are nearly in
    /// line, or do not meet, has a type-2 margin below a tenth, and the guard knows no
    /// more of it. See [`crate::guard::five_bar::FiveBar::margins`].
    pub fn is_known(self, value: Sine) -> bool {
        !matches!(self, Self::Type2(_)) || value != Sine(0)
    }
}

/// The first condition that a pose breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hazard {
    /// A margin is below its limit.
    Margin {
        /// Which one.
        margin: Margin,
        /// Its value.
        value: Sine,
    },
    /// A slider is outside its stroke.
    Stroke {
        /// Which one.
        side: Side,
        /// Its length, in its own steps.
        length: u16,
    },
    /// This servo does not turn so far.
    Travel(Servo),
}
