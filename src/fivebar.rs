//! How far a five-bar linkage is from its singularities, without a float.
//!
//! Two cranks hold the ends of two couplers whose common joint is the head
//! (or the tail). Where the crank tips meet, the couplers fold onto each
//! other and the joint is free to swing: a type-2 singularity. Where a crank
//! lines up with its coupler, the elbow can flip: type-1. The margins are the
//! sines of the angles between the bars, so 0 is singular and 1 is square.
//!
//! With `k` the vector from the left crank tip to the right one, `d = |k|`,
//! couplers of equal length `L`, the apex at height `h` above `k` and
//! `g = h / d`, so that `2 g = sqrt((4 L^2 - d^2) / d^2)`; for a crank of
//! direction `u`, with `cross = k_x u_y - k_y u_x` and `dot = k . u`:
//!
//! ```text
//! type-2                sin(theta3 - theta2) = h d / L^2 = 2 g d^2 / (2 L^2)
//! type-1, left     2 L  sin(theta1 - theta2) = cross - 2 g dot
//! type-1, right    2 L  sin(theta3 - theta4) = cross + 2 g dot
//! ```
//!
//! The paper's printed conditions, sin(theta2 + theta3) = 0 and
//! sin(2 theta11) = 0, are not used: both hold in the neutral pose, where the
//! robot stands safely, and miss the real singularity.

use lizard_avr::{mul, mul_unsigned};

use crate::slope::Slope;
use crate::trig::Direction;

/// One loop: its bars, and what the compiler can compute from them.
#[derive(Clone, Copy)]
pub struct FiveBar {
    /// Lengths in 1/256 mm.
    base: i16,
    left: i16,
    right: i16,
    /// `2 g` over the crank tips' squared distance.
    slope: Slope,
    /// Takes a squared distance to fifteen bits.
    square_shift: u8,
    /// One over `2 L^2`, in the scale that `square_shift` leaves.
    per_square: u16,
    /// `2^19 / L`, with `L` in mm.
    per_coupler: i16,
}

impl FiveBar {
    /// A loop with these bars in 1/256 mm: the distance between the shafts,
    /// the left and the right crank; and with the couplers of `slope`. Every
    /// bar is at most 127 mm and a coupler at least 17 mm long, which the
    /// build checks.
    pub const fn new(base: i16, left: i16, right: i16, slope: Slope) -> Self {
        let reach_sq = slope.reach_sq();
        let square_shift = 17 - reach_sq.leading_zeros() as u8;
        let largest = (reach_sq >> square_shift) as u64;
        Self {
            base,
            left,
            right,
            slope,
            square_shift,
            // 2 g d^2 is at most 2 L^2, half of the reach, in Q10 less nine.
            per_square: if largest > 1 << 14 {
                ((1u64 << 30) / largest) as u16
            } else {
                u16::MAX
            },
            per_coupler: ((1 << 27) / slope.coupler() as i32) as i16,
        }
    }

    /// The margins with the cranks in these directions, Q15: type-2, negative
    /// where the crank tips have crossed, beyond the singularity, where this
    /// robot cannot be; type-1 of the left and of the right crank, negative
    /// for an elbow bent inwards. All zero where the loop cannot close or the
    /// crank tips meet.
    pub fn margins(&self, left: Direction, right: Direction) -> [i16; 3] {
        // Half the unit of the bars, 1/128 mm, so that a distance of up to
        // 254 mm fits and the shift is one of whole bytes.
        let along = (self.base >> 1) + upper(mul(self.right, right.cos) - mul(self.left, left.cos));
        let across = upper(mul(self.right, right.sin) - mul(self.left, left.sin));
        let tips_sq = (mul(along, along) + mul(across, across)) as u32;
        let Some(slope) = self.slope.at(tips_sq) else {
            return [0; 3];
        };
        // To nearest: where the margin is small, so are the bits that are left.
        let square = ((tips_sq + (1 << (self.square_shift - 1))) >> self.square_shift) as i16;
        let area = (mul(slope, square) >> 9) as u16;
        let apex = saturate((mul_unsigned(area, self.per_square) >> 15) as i32);
        let tips = Tips { along, across };
        [
            if along > 0 { apex } else { -apex },
            self.elbow(tips, left, -slope),
            self.elbow(tips, right, slope),
        ]
    }

    /// The type-1 margin of a crank: `cross + 2 g dot` over `2 L`.
    fn elbow(&self, tips: Tips, crank: Direction, slope: i16) -> i16 {
        let cross = upper((mul(tips.along, crank.sin) - mul(tips.across, crank.cos)) << 1);
        let dot = upper((mul(tips.along, crank.cos) + mul(tips.across, crank.sin)) << 1);
        let opened = cross + (mul(slope, dot) >> 10) as i16;
        saturate(mul(opened, self.per_coupler) >> 12)
    }
}

/// The vector from the left crank tip to the right one, 1/128 mm.
#[derive(Clone, Copy)]
struct Tips {
    along: i16,
    across: i16,
}

/// A sine that rounding has pushed past 1 is 1.
fn saturate(margin: i32) -> i16 {
    margin.clamp(-0x7fff, 0x7fff) as i16
}

/// The upper half, rounded to nearest.
pub(crate) fn upper(product: i32) -> i16 {
    ((product + 0x8000) >> 16) as i16
}
