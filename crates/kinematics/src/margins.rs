//! The conditions of a safe pose, and the ten margins to which most of them apply.

use core::fmt;
use core::iter::zip;

/// A condition of a safe pose, to which a limit applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Check {
    /// Type-2 margin of the head, sin(theta3 - theta2).
    Type2Head,
    /// Type-2 margin of the tail, sin(theta7 - theta6) in the tail's own frame.
    Type2Tail,
    /// Type-1 margin of the arm on A1, sin(theta1 - theta2).
    Type1A1,
    /// Type-1 margin of the arm on A2, sin(theta3 - theta4).
    Type1A2,
    /// Type-1 margin of the arm on A3, sin(theta7 - theta8) in the tail's own frame.
    Type1A3,
    /// Type-1 margin of the arm on A4, sin(theta5 - theta6) in the tail's own frame.
    Type1A4,
    /// Margin of the left front leg, sin theta1.
    LegLf,
    /// Margin of the right front leg, sin theta4.
    LegRf,
    /// Margin of the right hind leg, -sin theta8.
    LegRh,
    /// Margin of the left hind leg, -sin theta5.
    LegLh,
    /// Travel of the left slider, mm.
    StrokeLeft,
    /// Travel of the right slider, mm.
    StrokeRight,
    /// Distance to the right, mm, from the tip of A1's crank to the tip of A2's: K2 in the paper. At 0 or below the
    /// cranks are crossed, which is possible only if the robot was assembled so.
    UncrossedHead,
    /// Distance to the right, mm, from the tip of A4's crank to the tip of A3's. At 0 or below the cranks are crossed.
    UncrossedTail,
}

impl Check {
    /// The type-2 margins of both ends, in the order of [`End::ALL`](crate::End::ALL).
    pub const TYPE2: [Self; 2] = [Self::Type2Head, Self::Type2Tail];
    /// The type-1 margins of the four arms, in servo order.
    pub const TYPE1: [Self; 4] = [Self::Type1A1, Self::Type1A2, Self::Type1A3, Self::Type1A4];
    /// The margins of the four legs, in servo order.
    pub const LEG: [Self; 4] = [Self::LegLf, Self::LegRf, Self::LegRh, Self::LegLh];
    /// The slider travels of both sides, in the order of [`Side::ALL`](crate::Side::ALL).
    pub const STROKE: [Self; 2] = [Self::StrokeLeft, Self::StrokeRight];
    /// The conditions that the crank tips are not crossed, in the order of [`End::ALL`](crate::End::ALL).
    pub const UNCROSSED: [Self; 2] = [Self::UncrossedHead, Self::UncrossedTail];

    /// The condition's name in JSON and in messages, such as `type2_head`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Type2Head => "type2_head",
            Self::Type2Tail => "type2_tail",
            Self::Type1A1 => "type1_a1",
            Self::Type1A2 => "type1_a2",
            Self::Type1A3 => "type1_a3",
            Self::Type1A4 => "type1_a4",
            Self::LegLf => "leg_lf",
            Self::LegRf => "leg_rf",
            Self::LegRh => "leg_rh",
            Self::LegLh => "leg_lh",
            Self::StrokeLeft => "stroke_left",
            Self::StrokeRight => "stroke_right",
            Self::UncrossedHead => "uncrossed_head",
            Self::UncrossedTail => "uncrossed_tail",
        }
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The ten margins of a pose. Each is the sine of an angle between two links, -1 to 1: 0 at a singularity or a change
/// point, positive on the side on which the robot is built. [`Check`] documents each of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// Type-2 margins of head and tail: [`Check::TYPE2`].
    pub type2: [f64; 2],
    /// Type-1 margins of the four arms, in servo order: [`Check::TYPE1`].
    pub type1: [f64; 4],
    /// Margins of the four legs, in servo order: [`Check::LEG`].
    pub leg: [f64; 4],
}

impl Margins {
    /// Iterates over all margins with their conditions.
    pub fn iter(&self) -> impl Iterator<Item = (Check, f64)> + use<> {
        zip(Check::TYPE2, self.type2)
            .chain(zip(Check::TYPE1, self.type1))
            .chain(zip(Check::LEG, self.leg))
    }

    /// The smallest margin with its condition; the first one if several are equal.
    pub fn min(&self) -> (Check, f64) {
        self.iter()
            .fold((Check::Type2Head, self.type2[0]), |min, next| {
                if next.1 < min.1 { next } else { min }
            })
    }
}
