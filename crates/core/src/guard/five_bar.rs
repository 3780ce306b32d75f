//! The distance of a five-bar linkage from its singularities, in integers.
//!
//! Two cranks carry two couplers, whose common joint is the end point, the head
//! or the tail. If the couplers line up, the end point can move although both servos
//! hold: a type-2 singularity. If a crank lines up with its coupler, the elbow can change
//! to its other working mode: type 1. The margins are the sines of the angles between the
//! bars, so 0 is singular and 1 is a right angle.
//!
//! theta1 and theta4 are the directions of the left and the right crank, theta2 and theta3 those of their couplers, as
//! in the paper. With `k` the vector from the left crank tip to the right one, couplers `a`
//! (left) and `b` (right), the rise and the skew of [`crate::numbers::couplers`] at
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

use crate::guard::trig::Direction;
use crate::numbers::bars::Bars;
use crate::numbers::couplers::{Couplers, Lean, Tables};
use crate::numbers::part::End;
use crate::numbers::robot::Robot;
use crate::numbers::units::Sine;

/// A five-bar linkage: its bars and the tables of its couplers.
#[derive(Clone, Copy, Debug)]
pub struct FiveBar<'a> {
    bars: Bars,
    tables: Tables<'a>,
}

/// The margins of the five-bar of head or tail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EndMargins {
    /// sin(theta3 - theta2). Negative where the crank tips have crossed, beyond the
    /// singularity, where a robot cannot be.
    pub type2: Sine,
    /// sin(theta1 - theta2), negative for an elbow bent inwards.
    pub type1_left: Sine,
    /// sin(theta3 - theta4), negative for an elbow bent inwards.
    pub type1_right: Sine,
}

impl<'a> FiveBar<'a> {
    /// A linkage without bars, which never closes.
    pub const NONE: Self = Self::new(Bars::NONE, Tables::NONE);

    /// A loop of these bars, with the tables of its couplers.
    pub const fn new(bars: Bars, tables: Tables<'a>) -> Self {
        Self { bars, tables }
    }

    /// The bars of the loop.
    pub const fn bars(&self) -> &Bars {
        &self.bars
    }

    /// The margins with the cranks in these directions of the end's own frame. All are zero if the loop cannot
    /// close, or if its type-2 margin is below a tenth and the tables have no value there.
    #[inline(never)]
    pub fn margins(&self, left: &Direction, right: &Direction) -> EndMargins {
        let bars = &self.bars;
        // One unit is two steps of the bars, so that the vector fits into 16 bits and each product is shifted by whole
        // bytes.
        let tips = TipVector {
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
        // Rounded to nearest, since a small margin leaves few bits.
        let square = (tips_sq + (1 << (bars.square_shift - 1))) >> bars.square_shift;
        let square = square.min(0x7fff) as i16;
        let area = (mul(rise, square) >> bars.area_shift) as u16;
        let magnitude = saturate((mul_unsigned(area, bars.per_area) >> 15) as i32);
        EndMargins {
            type2: Sine(if tips.along > 0 {
                magnitude
            } else {
                -magnitude
            }),
            type1_left: tips.type1_margin(left, rise.wrapping_neg(), skew, bars.per_left),
            type1_right: tips.type1_margin(right, rise, skew.wrapping_neg(), bars.per_right),
        }
    }
}

impl<'a> Robot<'a> {
    /// The five-bar of head or tail, in its own frame.
    pub fn end(&self, end: End) -> FiveBar<'a> {
        FiveBar::new(self.bars(end), self.tables(end))
    }
}

/// The vector from the left crank tip to the right one, in units of two steps of the bars.
#[derive(Clone, Copy)]
struct TipVector {
    along: i16,
    across: i16,
}

impl TipVector {
    /// The type-1 margin of a crank: `(1 + skew) cross + rise dot` over twice the length of
    /// its coupler.
    #[inline(never)]
    fn type1_margin(self, crank: &Direction, rise: i16, skew: i16, per_coupler: i16) -> Sine {
        let cross = upper((mul(self.along, crank.sin) - mul(self.across, crank.cos)) << 1);
        let dot = upper((mul(self.along, crank.cos) + mul(self.across, crank.sin)) << 1);
        // The sum is at most twice the coupler; an overflow of its parts beyond 16 bits cancels.
        let mut scaled_sine = cross.wrapping_add((mul(rise, dot) >> 10) as i16);
        if skew != 0 {
            scaled_sine = scaled_sine.wrapping_add((mul(skew, cross) >> 10) as i16);
        }
        Sine(saturate(mul(scaled_sine, per_coupler) >> 12))
    }
}

/// Limits a sine that rounding has pushed past 1.
fn saturate(margin: i32) -> i16 {
    margin.clamp(-0x7fff, 0x7fff) as i16
}

/// The upper 16 bits of a product, rounded to nearest.
pub(crate) fn upper(product: i32) -> i16 {
    (product.wrapping_add(0x8000) >> 16) as i16
}

#[cfg(test)]
mod tests;
