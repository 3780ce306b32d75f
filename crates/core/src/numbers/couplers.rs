//! The triangle formed by the two couplers and the line between the crank tips.
//!
//! Couplers of lengths `a` (left) and `b` (right) are joined at the end point, the head or the tail. The shape of the
//! triangle depends only on the squared distance `s` between the crank tips. The margins depend on two functions of
//! `s`:
//!
//! ```text
//! rise = 2 height / distance    = sqrt((R - s) (s - N)) / s    R = (a + b)^2, N = (a - b)^2
//! skew = 2 foot / distance - 1  = (a^2 - b^2) / s              0 for equal couplers
//! ```
//!
//! `height` is the distance of the end point from the line between the crank tips, by Heron's formula; `foot` is the
//! distance from the left crank tip to the foot of this height. Both functions are read from a [`Curve`]. At either
//! limit of the range of `s`, `R` for stretched couplers and `N` for folded couplers, the rise falls to zero like a
//! square root, too steeply for a table over `s`. Therefore the rise near each limit is read from another table, over
//! the distance from the limit, `R - s` or `s - N`. A robot that cannot reach a limit does not have the table for this
//! limit. The rise is largest at `s = 2 R N / (R + N)`, which is below `2 N`. The table over `s` holds the falling part
//! above this peak, and the largest rise below the peak.

use lizard_avr::Flash;

use crate::numbers::curve::{Curve, OCTAVE_COUNT, Table, argument_at};

/// The tables of a pair of couplers, Q10; `None` in place of a table that the robot does not require.
#[derive(Clone, Copy, Debug)]
pub struct CouplerTables<'a> {
    /// The rise over `s`, made by [`compute_rise_table`].
    pub rise: Option<Flash<'a, Table>>,
    /// The rise over `R - s`, made by [`compute_stretched_rise_table`], for a five-bar whose crank tips can be so far
    /// apart that [`Couplers::is_near_stretched`] is true.
    pub stretched_rise: Option<Flash<'a, Table>>,
    /// The rise over `s - N`, made by [`compute_folded_rise_table`], for couplers with which
    /// [`Couplers::needs_folded_table`] is true.
    pub folded_rise: Option<Flash<'a, Table>>,
    /// The magnitude of the skew over `s`, made by [`compute_skew_table`], for unequal couplers.
    pub skew: Option<Flash<'a, Table>>,
}

lizard_avr::pod! {
    /// The lengths of a five-bar's two couplers, in steps, and values derived from these lengths.
    #[derive(Debug, PartialEq, Eq)]
    pub struct CouplerLengths {
        left: i16,
        right: i16,
        /// `R` in the unit of `s`: four squared steps of the links.
        reach_sq: u32,
        /// `N` in the unit of `s`.
        folded_sq: u32,
        /// The number of leading zeros of `reach_sq`.
        reach_zeros: u16,
        /// The number of leading zeros of `folded_sq`.
        folded_zeros: u16,
    }
}

impl CouplerLengths {
    /// Creates the lengths of a left and a right coupler, in steps.
    pub const fn new(left: i16, right: i16) -> Self {
        let [reach_sq, folded_sq] = compute_limits_sq(left, right);
        Self {
            left,
            right,
            reach_sq,
            folded_sq,
            reach_zeros: reach_sq.leading_zeros() as u16,
            folded_zeros: folded_sq.leading_zeros() as u16,
        }
    }
}

/// The two couplers of a five-bar with their tables.
#[derive(Clone, Copy)]
pub struct Couplers<'a> {
    lengths: CouplerLengths,
    tables: CouplerTables<'a>,
}

/// The shape of the couplers' triangle at a distance between the crank tips, Q10.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriangleShape {
    /// Twice the height of the end point, divided by the distance between the crank tips.
    pub rise: i16,
    /// Twice the foot of the height, divided by the distance between the crank tips, minus one.
    pub skew: i16,
}

impl<'a> Couplers<'a> {
    /// Creates couplers from their lengths and tables. A shape that requires a missing table is unknown.
    pub const fn new(lengths: CouplerLengths, tables: CouplerTables<'a>) -> Self {
        Self { lengths, tables }
    }

    /// True if the lengths differ so much that the table over `s` begins below `2 N`. The table for folded couplers
    /// then contains the rise from `2 N` down to the folded position, `s = N`. For other couplers,
    /// [`Couplers::shape_at`] returns `None` near the folded position.
    pub const fn needs_folded_table(left: i16, right: i16) -> bool {
        let [reach_sq, folded_sq] = compute_limits_sq(left, right);
        2 * folded_sq > reach_sq >> OCTAVE_COUNT
    }

    /// True if the squared distance between the crank tips, `tips_sq`, is above three quarters of `R`. There the rise
    /// is read from the table for stretched couplers.
    pub const fn is_near_stretched(left: i16, right: i16, tips_sq: u32) -> bool {
        let [reach_sq, _] = compute_limits_sq(left, right);
        is_near_stretched(reach_sq, tips_sq)
    }

    /// Returns the shape at a squared distance between the crank tips, in units of four squared steps of the links.
    /// Returns `None` if the loop does not close, and also where the tables have no value: near the distances at which
    /// the loop just closes, and near coinciding crank tips. The type-2 margin is then below a tenth, the smallest
    /// limit that a robot may have.
    #[inline(always)]
    pub fn shape_at(&self, tips_sq: u32) -> Option<TriangleShape> {
        let Self { lengths, tables } = self;
        let (reach_sq, folded_sq) = (lengths.reach_sq, lengths.folded_sq);
        if tips_sq >= reach_sq {
            return None;
        }
        let rise = match (tables.stretched_rise, tables.folded_rise) {
            (Some(stretched), _) if is_near_stretched(reach_sq, tips_sq) => {
                Curve::with_leading_zeros(stretched, lengths.reach_zeros + 2)
                    .at(reach_sq - tips_sq)?
            }
            (_, Some(folded)) if tips_sq < 2 * folded_sq => {
                Curve::with_leading_zeros(folded, lengths.folded_zeros)
                    .at(tips_sq.checked_sub(folded_sq)?)?
            }
            _ => Curve::with_leading_zeros(tables.rise?, lengths.reach_zeros)
                .at_rounded_up(tips_sq)?,
        };
        let skew = match tables.skew {
            Some(skew) => {
                let magnitude =
                    Curve::with_leading_zeros(skew, lengths.reach_zeros).at_rounded_up(tips_sq)?;
                if lengths.left < lengths.right {
                    magnitude.wrapping_neg()
                } else {
                    magnitude
                }
            }
            None => 0,
        };
        Some(TriangleShape { rise, skew })
    }
}

/// Implements [`Couplers::is_near_stretched`].
const fn is_near_stretched(reach_sq: u32, tips_sq: u32) -> bool {
    tips_sq > reach_sq - reach_sq / 4
}

/// Computes the table of the rise over `s`, for couplers of these lengths; a host calls it.
pub fn compute_rise_table(left: i16, right: i16) -> Table {
    let [reach_sq, folded_sq] = compute_limits_sq(left, right);
    let peak_sq = compute_peak_sq(left, right).into();
    // Rounded down, because a straight line between two points of this curve lies above it.
    core::array::from_fn(|index| {
        let tips_sq = argument_at(reach_sq, index).max(peak_sq);
        compute_rise_q10(reach_sq, folded_sq, tips_sq, 0)
    })
}

/// Computes the table of the rise over `R - s`; a host calls it.
pub fn compute_stretched_rise_table(left: i16, right: i16) -> Table {
    let [reach_sq, folded_sq] = compute_limits_sq(left, right);
    core::array::from_fn(|index| {
        let shortfall_sq = argument_at(reach_sq / 4, index);
        let tips_sq = u64::from(reach_sq).saturating_sub(shortfall_sq);
        compute_rise_q10(reach_sq, folded_sq, tips_sq, 1)
    })
}

/// Computes the table of the rise over `s - N`; a host calls it.
pub fn compute_folded_rise_table(left: i16, right: i16) -> Table {
    let [reach_sq, folded_sq] = compute_limits_sq(left, right);
    core::array::from_fn(|index| {
        let tips_sq = u64::from(folded_sq) + argument_at(folded_sq, index);
        compute_rise_q10(reach_sq, folded_sq, tips_sq, 1)
    })
}

/// Computes the table of the skew's magnitude over `s`; a host calls it.
pub fn compute_skew_table(left: i16, right: i16) -> Table {
    let [reach_sq, _] = compute_limits_sq(left, right);
    // |a^2 - b^2| in the unit of `s`, four squared steps of the links.
    let difference = (i64::from(left).pow(2) - i64::from(right).pow(2)).unsigned_abs() / 4;
    core::array::from_fn(|index| {
        let tips_sq = argument_at(reach_sq, index);
        let skew = ((difference << 10) + tips_sq / 2) / tips_sq;
        skew.min(0x7fff) as i16
    })
}

/// Computes the rise, `sqrt((R - s)(s - N)) / s`, Q10, rounded to nearest if `rounding` is 1, or down if it is 0.
/// Returns 0 unless `s` is between `N` and `R`.
fn compute_rise_q10(reach_sq: u32, folded_sq: u32, tips_sq: u64, rounding: u128) -> i16 {
    let (reach_sq, folded_sq) = (u64::from(reach_sq), u64::from(folded_sq));
    if tips_sq >= reach_sq || tips_sq <= folded_sq {
        return 0;
    }
    let product = (reach_sq - tips_sq) as u128 * (tips_sq - folded_sq) as u128;
    // One bit more than Q10, for rounding.
    let twice_rise = ((product << 22) / (tips_sq as u128 * tips_sq as u128)).isqrt();
    let rise = (twice_rise + rounding) >> 1;
    rise.min(0x7fff) as i16
}

/// Computes the limits `R` and `N` in the unit of `s`, four squared steps of the links.
const fn compute_limits_sq(left: i16, right: i16) -> [u32; 2] {
    let sum = left as u32 + right as u32;
    // A quarter of the squared sum, rounded down; for equal couplers exactly the squared length of a coupler.
    let reach_sq = sum / 2 * (sum / 2) + if sum % 2 == 1 { sum / 2 } else { 0 };
    let difference = left.abs_diff(right) as u32;
    [reach_sq, difference * difference / 4]
}

/// Computes the `s` at which the rise is largest.
fn compute_peak_sq(left: i16, right: i16) -> u32 {
    let [reach_sq, folded_sq] = compute_limits_sq(left, right).map(u64::from);
    (2 * reach_sq * folded_sq / (reach_sq + folded_sq)) as u32
}

const _: () = assert!(
    OCTAVE_COUNT == 10,
    "guard::bounds assumes OCTAVE_COUNT = 10: derive its bounds again"
);

#[cfg(test)]
mod tests;
