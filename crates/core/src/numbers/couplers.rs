//! The triangle formed by the two couplers and the line between the crank tips.
//!
//! Couplers of lengths `a` (left) and `b` (right) are joined at the end point, the head or the tail. The shape of the
//! triangle depends only on the squared distance `s` of the crank tips. The margins need just two functions of `s`:
//!
//! ```text
//! rise = 2 height / distance    = sqrt((R - s) (s - N)) / s    R = (a + b)^2, N = (a - b)^2
//! skew = 2 foot / distance - 1  = (a^2 - b^2) / s              0 for equal couplers
//! ```
//!
//! (height and foot of the end point over the line, the foot counted from the left crank tip; Heron's formula gives
//! the height.) Both are read from a [`Curve`]. At either limit of its range the rise falls to zero like a square
//! root, too steeply for a table over `s`. So near each limit the rise is a function of the distance from that limit,
//! `R - s` or `s - N`, with its own table. A robot that cannot reach a limit does not have the table for it. The rise
//! is largest at `s = 2 R N / (R + N)`, which is below `2 N`. The table over `s` holds the falling part above that
//! point; below it, the table holds the largest rise.

use lizard_avr::Flash;

use crate::numbers::curve::{Curve, OCTAVES, Table, argument};

/// The tables of a pair of couplers. Q10.
#[derive(Clone, Copy, Debug)]
pub struct Tables<'a> {
    /// The rise over `s`, made by [`rise`].
    pub rise: Option<Flash<'a, Table>>,
    /// The rise over `R - s`, made by [`stretched`]; for a loop whose crank tips can be so far apart that
    /// [`Couplers::is_near_stretched`] is true.
    pub stretched: Option<Flash<'a, Table>>,
    /// The rise over `s - N`, made by [`folded`]; for couplers for which [`Couplers::differ_much`] is true.
    pub folded: Option<Flash<'a, Table>>,
    /// The skew over `s`, made by [`skew`]; for unequal couplers.
    pub skew: Option<Flash<'a, Table>>,
}

impl Tables<'_> {
    /// No tables: every lean is unknown.
    pub const NONE: Self = Self {
        rise: None,
        stretched: None,
        folded: None,
        skew: None,
    };
}

lizard_avr::plain! {
    /// The lengths of the two couplers of a loop, in its steps, and values derived from them.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Coupling {
        left: i16,
        right: i16,
        /// `R` in the units of `s`: four squared steps of the bars.
        reach_sq: u32,
        /// `N` in the units of `s`.
        least_sq: u32,
        /// Leading zeros of `reach_sq`.
        reach_zeros: u16,
        /// Leading zeros of `least_sq`.
        least_zeros: u16,
    }
}

impl Coupling {
    /// Couplers without length, which never close a loop.
    pub const NONE: Self = Self {
        left: 0,
        right: 0,
        reach_sq: 0,
        least_sq: 0,
        reach_zeros: 32,
        least_zeros: 32,
    };

    /// Couplers of these lengths.
    pub const fn new(left: i16, right: i16) -> Self {
        Self {
            left,
            right,
            reach_sq: reach_sq(left, right),
            least_sq: folded_sq(left, right),
            reach_zeros: reach_sq(left, right).leading_zeros() as u16,
            least_zeros: folded_sq(left, right).leading_zeros() as u16,
        }
    }

    /// The length of the left coupler.
    pub const fn left(&self) -> i16 {
        self.left
    }

    /// The length of the right coupler.
    pub const fn right(&self) -> i16 {
        self.right
    }

    /// Implements [`Couplers::differ_much`].
    pub const fn differs_much(&self) -> bool {
        2 * self.least_sq > self.reach_sq >> OCTAVES
    }
}

/// The two couplers of a loop, and their tables.
#[derive(Clone, Copy)]
pub struct Couplers<'a> {
    lengths: Coupling,
    tables: Tables<'a>,
}

/// The shape of the couplers' triangle at one distance of the crank tips, Q10.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lean {
    /// Twice the height of the end point over the distance of the crank tips.
    pub rise: i16,
    /// Twice the foot of that height over the distance, less one.
    pub skew: i16,
}

impl<'a> Couplers<'a> {
    /// Couplers of these lengths, in the steps of their loop, with their tables. A lean that needs a missing table is
    /// unknown.
    pub const fn new(lengths: Coupling, tables: Tables<'a>) -> Self {
        Self { lengths, tables }
    }

    /// True if the lengths differ so much that the table over `s` begins below `2 N`. The table of folded couplers
    /// then gives the rise from `2 N` down to the folded position, `s = N`. For other couplers, [`Couplers::at`]
    /// returns `None` near the folded position.
    pub const fn differ_much(left: i16, right: i16) -> bool {
        Coupling::new(left, right).differs_much()
    }

    /// True if the squared distance of the crank tips is above three quarters of `R`: there the rise is read from the
    /// table of stretched couplers.
    pub const fn is_near_stretched(left: i16, right: i16, tips_sq: u32) -> bool {
        is_near_stretched(reach_sq(left, right), tips_sq)
    }

    /// The lean at a squared distance of the crank tips, in units of four squared steps of the bars. `None` if the
    /// couplers do not close the loop. Also `None` near the distances at which the loop just closes, and near
    /// coinciding crank tips, where the tables have no value; the type-2 margin is then below a tenth, the smallest
    /// limit that a robot may have.
    #[inline(always)]
    pub fn at(&self, tips_sq: u32) -> Option<Lean> {
        let Self { lengths, tables } = self;
        let (reach_sq, least_sq) = (lengths.reach_sq, lengths.least_sq);
        if tips_sq >= reach_sq {
            return None;
        }
        let rise = match (tables.stretched, tables.folded) {
            (Some(stretched), _) if is_near_stretched(reach_sq, tips_sq) => {
                Curve::of_octave(stretched, lengths.reach_zeros + 2).at(reach_sq - tips_sq)?
            }
            (_, Some(folded)) if tips_sq < 2 * least_sq => {
                Curve::of_octave(folded, lengths.least_zeros).at(tips_sq.checked_sub(least_sq)?)?
            }
            _ => Curve::of_octave(tables.rise?, lengths.reach_zeros).at_rounded_up(tips_sq)?,
        };
        let skew = match tables.skew {
            Some(skew) => {
                let magnitude =
                    Curve::of_octave(skew, lengths.reach_zeros).at_rounded_up(tips_sq)?;
                if lengths.left < lengths.right {
                    magnitude.wrapping_neg()
                } else {
                    magnitude
                }
            }
            None => 0,
        };
        Some(Lean { rise, skew })
    }
}

/// Implements [`Couplers::is_near_stretched`].
const fn is_near_stretched(reach_sq: u32, tips_sq: u32) -> bool {
    tips_sq > reach_sq - reach_sq / 4
}

/// The rise over `s` for couplers of these lengths; made by a host.
pub fn rise(left: i16, right: i16) -> Table {
    let (reach_sq, least_sq) = (reach_sq(left, right), folded_sq(left, right));
    let peak_sq = peak_sq(left, right).into();
    // Rounded down, because a straight line between two points of this curve lies above it.
    core::array::from_fn(|index| {
        let tips_sq = argument(reach_sq, index).max(peak_sq);
        rise_q10(reach_sq, least_sq, tips_sq, 0)
    })
}

/// The rise over `R - s`; made by a host.
pub fn stretched(left: i16, right: i16) -> Table {
    let (reach_sq, least_sq) = (reach_sq(left, right), folded_sq(left, right));
    core::array::from_fn(|index| {
        let shortfall_sq = argument(reach_sq / 4, index);
        let tips_sq = u64::from(reach_sq).saturating_sub(shortfall_sq);
        rise_q10(reach_sq, least_sq, tips_sq, 1)
    })
}

/// The rise over `s - N`; made by a host.
pub fn folded(left: i16, right: i16) -> Table {
    let (reach_sq, least_sq) = (reach_sq(left, right), folded_sq(left, right));
    core::array::from_fn(|index| {
        let tips_sq = u64::from(least_sq) + argument(least_sq, index);
        rise_q10(reach_sq, least_sq, tips_sq, 1)
    })
}

/// The magnitude of the skew over `s`; made by a host.
pub fn skew(left: i16, right: i16) -> Table {
    let reach_sq = reach_sq(left, right);
    // a^2 - b^2 in the units of `s`: four squared steps of the bars.
    let difference = (i64::from(left).pow(2) - i64::from(right).pow(2)).unsigned_abs() / 4;
    core::array::from_fn(|index| {
        let tips_sq = argument(reach_sq, index);
        let skew = ((difference << 10) + tips_sq / 2) / tips_sq;
        skew.min(0x7fff) as i16
    })
}

/// `sqrt((R - s)(s - N)) / s` in Q10, rounded to nearest if `round` is 1, down if it is 0; 0 outside of N..R.
fn rise_q10(reach_sq: u32, least_sq: u32, tips_sq: u64, round: u128) -> i16 {
    let (reach_sq, least_sq) = (u64::from(reach_sq), u64::from(least_sq));
    if tips_sq >= reach_sq || tips_sq <= least_sq {
        return 0;
    }
    let product = (reach_sq - tips_sq) as u128 * (tips_sq - least_sq) as u128;
    // One bit more than Q10 for the rounding.
    let twice_rise = ((product << 22) / (tips_sq as u128 * tips_sq as u128)).isqrt();
    let rise = (twice_rise + round) >> 1;
    rise.min(0x7fff) as i16
}

/// Computes `R` in the units of `s`: four squared steps of the bars.
const fn reach_sq(left: i16, right: i16) -> u32 {
    let sum = left as u32 + right as u32;
    // A quarter of the squared sum, rounded down; for equal couplers exactly the squared coupler.
    sum / 2 * (sum / 2) + if sum % 2 == 1 { sum / 2 } else { 0 }
}

/// Computes `N` in the units of `s`.
const fn folded_sq(left: i16, right: i16) -> u32 {
    let difference = left.abs_diff(right) as u32;
    difference * difference / 4
}

/// The value of `s` at which the rise is largest.
fn peak_sq(left: i16, right: i16) -> u32 {
    let (reach_sq, least_sq) = (reach_sq(left, right) as u64, folded_sq(left, right) as u64);
    (2 * reach_sq * least_sq / (reach_sq + least_sq)) as u32
}

const _: () = assert!(OCTAVES == 10, "1/1024 of R is a type-2 margin of .06");

#[cfg(test)]
mod tests;
