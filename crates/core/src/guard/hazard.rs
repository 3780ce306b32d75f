//! Hazards: the limit that a pose violates, and the value that violates it.

use crate::numbers::part::{End, Servo, Side};
use crate::numbers::units::Sine;

/// One of the ten margins of a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Discriminants start at 3: the compiler then stores the other two hazards as 1 and 2, and the absence of a hazard as
// 0, so that all bits of `Main::new` are zero.
#[repr(u8)]
pub enum Margin {
    /// The margin between the two couplers of an end.
    Type2(End) = 3,
    /// The margin between a servo's crank and its coupler, negative if the elbow is bent inwards.
    Type1(Servo),
    /// The margin of a servo's parallelogram leg, negative beyond a change point.
    Leg(Servo),
}

impl Margin {
    /// True if `value` is a computed margin; false for a type-2 margin of 0, which means only that the couplers are
    /// nearly in line or cannot meet, and that their margin is below a tenth; see
    /// [`crate::guard::five_bar::FiveBar::margins`].
    pub fn is_known(self, value: Sine) -> bool {
        !matches!(self, Self::Type2(_)) || value != Sine(0)
    }
}

/// The first limit that a pose violates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hazard {
    /// A margin is below its limit.
    Margin {
        /// The margin that is too small.
        margin: Margin,
        /// The value of the margin.
        value: Sine,
    },
    /// A slider is outside its stroke.
    Stroke {
        /// The side of the slider.
        side: Side,
        /// The slider's length, in its own steps.
        length: u16,
    },
    /// The pose is beyond the travel of this servo.
    Travel(Servo),
}
