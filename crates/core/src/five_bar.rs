//! How far a five-bar linkage is from its singularities, without a float.
//!
//! Two cranks hold the ends of two couplers whose common joint is the end point, the head
//! or the tail. If the couplers line up, the end point can move although both servos
//! hold: a type-2 singularity. If a crank lines up with its coupler, the elbow can change
//! to its other working mode: type 1. The margins are the sines of the angles between the
//! bars, so 0 is singular and 1 is a right angle.
//!
//! With `k` the vector from the left crank tip to the right one, couplers `a`
//! (left) and `b` (right), the rise and the skew of [`crate::couplers`] at
//! `s = |k|^2`, and for a crank of direction `u` `cross = k_x u_y - k_y u_x` and
//! `dot = k . u`:
//!
//! ```text
//! type-2       2 a b sin(theta3 - theta2) = rise s
//! type-1, left   2 a sin(theta1 - theta2) = (1 + skew) cross - rise dot
//! type-1, right  2 b sin(theta3 - theta4) = (1 - skew) cross + rise dot
//! ```
//!
//! The paper's printed conditions, sin(theta2 + theta3) = 0 and
//! sin(2 theta11) = 0, are not used: both hold in the neutral pose, where the
//! robot stands safely, and miss the real singularity.

use lizard_avr::{mul, mul_unsigned};

use crate::couplers::{Couplers, Coupling, Lean, Tables};
use crate::trig::Direction;
use crate::units::{Scale, Sine};

/// The longest that a loop's bars may be, in steps: l0 + l1 + l4, and each coupler.
pub const LONGEST: f64 = 127.0 * 256.0;

/// The shortest coupler, in steps.
pub const SHORTEST_COUPLER: i16 = 4097;

lizard_avr::plain! {
    /// The bars of one loop, and what follows from them. A length is counted in steps of
    /// which `scale` says how many are a millimetre; margins do not depend on it.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Bars {
        couplers: Coupling,
        base: i16,
        left: i16,
        right: i16,
        /// One over `4 a b`, in the scale that the shifts leave.
        per_area: u16,
        /// `2^27` over each coupler.
        per_left: i16,
        per_right: i16,
        /// Takes a squared distance of the crank tips to fifteen bits.
        square_shift: u16,
        /// Takes rise times that to sixteen bits.
        area_shift: u16,
        scale: Scale,
        /// Nothing: it fills up what the fields above leave of four bytes.
        rest: u16,
    }
}

/// One loop: its bars and the curves of its couplers.
#[derive(Clone, Copy, Debug)]
pub struct FiveBar<'a> {
    bars: Bars,
    tables: Tables<'a>,
}

/// The margins of one end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EndMargins {
    /// sin(theta3 - theta2). Negative where the crank tips have crossed, beyond the
    /// singularity, where a robot cannot be.
    pub type2: Sine,
    /// sin(theta1 - theta2), negative for an elbow bent inwards.
    pub type1_left: Sine,
    /// sin(theta3 - theta4), likewise.
    pub type1_right: Sine,
}

impl Bars {
    /// No loop: it never closes.
    pub const NONE: Self = Self {
        base: 0,
        left: 0,
        right: 0,
        couplers: Coupling::NONE,
        square_shift: 1,
        area_shift: 0,
        per_area: 0,
        per_left: 0,
        per_right: 0,
        scale: Scale { bits: 0 },
        rest: 0,
    };

    /// A loop with these bars, in steps: the distance between the shafts, the left
    /// and the right crank, which are at most [`LONGEST`] together; and two
    /// couplers.
    ///
    /// # Panics
    /// Where a coupler is shorter than [`SHORTEST_COUPLER`].
    pub const fn new([base, left, right]: [i16; 3], [a, b]: [i16; 2], scale: Scale) -> Self {
        assert!(a >= SHORTEST_COUPLER && b >= SHORTEST_COUPLER);
        let half_sum = (a as u32 + b as u32) / 2;
        let square_shift = 17 - (half_sum * half_sum).leading_zeros() as u16;
        let mut area = (a as u64 * b as u64) >> square_shift;
        let mut area_shift = 9;
        while area < 1 << 14 {
            area <<= 1;
            area_shift -= 1;
        }
        Self {
            base,
            left,
            right,
            couplers: Coupling::new(a, b),
            square_shift,
            area_shift,
            per_area: if area > 1 << 14 {
                ((1u64 << 30) / area) as u16
            } else {
                u16::MAX
            },
            per_left: ((1 << 27) / a as i32) as i16,
            per_right: ((1 << 27) / b as i32) as i16,
            scale,
            rest: 0,
        }
    }

    /// The step of the lengths.
    pub const fn scale(&self) -> Scale {
        self.scale
    }

    /// The couplers.
    pub const fn couplers(&self) -> Coupling {
        self.couplers
    }
}

impl<'a> FiveBar<'a> {
    /// No loop: it never closes.
    pub const NONE: Self = Self::new(Bars::NONE, Tables::NONE);

    /// A loop with these bars, and the curves of its couplers.
    pub const fn new(bars: Bars, tables: Tables<'a>) -> Self {
        Self { bars, tables }
    }

    /// Its bars.
    pub const fn bars(&self) -> &Bars {
        &self.bars
    }

    /// The margins with the cranks in these directions of the end's own frame. All
    /// zero where the loop cannot close, or is so near to that that its type-2 margin
    /// is below a tenth and the tables have no value.
    #[inline(never)]
    pub fn margins(&self, left: &Direction, right: &Direction) -> EndMargins {
        let bars = &self.bars;
        // Half the step of the bars, so that the distance of the crank tips fits
        // and the shift is one of whole bytes.
        let tips = Tips {
            along: (bars.base >> 1)
                .wrapping_add(upper(mul(bars.right, right.cos) - mul(bars.left, left.cos))),
            across: upper(mul(bars.right, right.sin) - mul(bars.left, left.sin)),
        };
        let tips_sq =
            mul(tips.along, tips.along).wrapping_add(mul(tips.across, tips.across)) as u32;
        let Some(Lean { rise, skew }) = Couplers::new(bars.couplers, self.tables).at(tips_sq)
        else {
            return EndMargins::default();
        };
        // To nearest: where the margin is small, so are the bits that are left.
        let square = (tips_sq + (1 << (bars.square_shift - 1))) >> bars.square_shift;
        let square = square.min(0x7fff) as i16;
        let area = (mul(rise, square) >> bars.area_shift) as u16;
        let size = saturate((mul_unsigned(area, bars.per_area) >> 15) as i32);
        EndMargins {
            type2: Sine(if tips.along > 0 { size } else { -size }),
            type1_left: tips.elbow(left, rise.wrapping_neg(), skew, bars.per_left),
            type1_right: tips.elbow(right, rise, skew.wrapping_neg(), bars.per_right),
        }
    }
}

/// The vector from the left crank tip to the right one, in half steps.
#[derive(Clone, Copy)]
struct Tips {
    along: i16,
    across: i16,
}

impl Tips {
    /// The type-1 margin of a crank: `(1 + skew) cross + rise dot` over twice its
    /// coupler.
    #[inline(never)]
    fn elbow(self, crank: &Direction, rise: i16, skew: i16, per_coupler: i16) -> Sine {
        let cross = upper((mul(self.along, crank.sin) - mul(self.across, crank.cos)) << 1);
        let dot = upper((mul(self.along, crank.cos) + mul(self.across, crank.sin)) << 1);
        // The sum is at most twice the coupler; what its parts exceed 16 bits by
        // cancels.
        let mut opened = cross.wrapping_add((mul(rise, dot) >> 10) as i16);
        if skew != 0 {
            opened = opened.wrapping_add((mul(skew, cross) >> 10) as i16);
        }
        Sine(saturate(mul(opened, per_coupler) >> 12))
    }
}

/// A sine that rounding has pushed past 1 is 1.
fn saturate(margin: i32) -> i16 {
    margin.clamp(-0x7fff, 0x7fff) as i16
}

/// The upper half, rounded to nearest.
pub(crate) fn upper(product: i32) -> i16 {
    (product.wrapping_add(0x8000) >> 16) as i16
}

#[cfg(test)]
mod tests;
