//! How far a pose is from each singularity.

use core::fmt;

/// What a limit is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Check {
    /// Type-2 of the head, sin(theta3 - theta2).
    ApexHead,
    /// Type-2 of the tail, sin(theta7 - theta6) in tail-local angles.
    ApexTail,
    /// Type-1 of the arm on A1, sin(theta1 - theta2).
    Type1A1,
    /// Type-1 of the arm on A2, sin(theta3 - theta4).
    Type1A2,
    /// Type-1 of the arm on A3.
    Type1A3,
    /// Type-1 of the arm on A4.
    Type1A4,
    /// Front left leg, |sin theta1|.
    LegFl,
    /// Front right leg, |sin theta4|.
    LegFr,
    /// Back right leg, |sin theta8|.
    LegBr,
    /// Back left leg, |sin theta5|.
    LegBl,
    /// Travel of the left slider, mm.
    StrokeLeft,
    /// Travel of the right slider, mm.
    StrokeRight,
    /// Across, in mm, from the tip of A1's crank to the tip of A2's: K2 in the
    /// paper. Not above 0, the cranks are crossed, a state that the robot can
    /// only have been assembled in.
    UncrossedHead,
    /// Likewise from A4's to A3's.
    UncrossedTail,
}

impl Check {
    /// The name in JSON and in answers, such as `apex_head`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ApexHead => "apex_head",
            Self::ApexTail => "apex_tail",
            Self::Type1A1 => "type1_a1",
            Self::Type1A2 => "type1_a2",
            Self::Type1A3 => "type1_a3",
            Self::Type1A4 => "type1_a4",
            Self::LegFl => "leg_fl",
            Self::LegFr => "leg_fr",
            Self::LegBr => "leg_br",
            Self::LegBl => "leg_bl",
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

/// All ten margins of a pose. Each is the sine of an angle between two links:
/// 0 at a singularity, at most 1. Type-1 margins are positive for the outward
/// elbows that the robot is built with.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // `Check` documents each.
pub struct Margins<T = f64> {
    pub apex_head: T,
    pub apex_tail: T,
    pub type1_a1: T,
    pub type1_a2: T,
    pub type1_a3: T,
    pub type1_a4: T,
    pub leg_fl: T,
    pub leg_fr: T,
    pub leg_br: T,
    pub leg_bl: T,
}

impl Margins {
    /// Every margin with its name.
    pub fn iter(&self) -> impl Iterator<Item = (Check, f64)> + use<> {
        [
            (Check::ApexHead, self.apex_head),
            (Check::ApexTail, self.apex_tail),
            (Check::Type1A1, self.type1_a1),
            (Check::Type1A2, self.type1_a2),
            (Check::Type1A3, self.type1_a3),
            (Check::Type1A4, self.type1_a4),
            (Check::LegFl, self.leg_fl),
            (Check::LegFr, self.leg_fr),
            (Check::LegBr, self.leg_br),
            (Check::LegBl, self.leg_bl),
        ]
        .into_iter()
    }

    /// The smallest margin with its name.
    pub fn min(&self) -> (Check, f64) {
        self.iter()
            .fold((Check::ApexHead, self.apex_head), |least, next| {
                if next.1 < least.1 { next } else { least }
            })
    }
}
