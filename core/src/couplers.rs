//! The triangle of the two couplers over the line between the crank tips.
//!
//! Couplers of lengths `a` (left) and `b` (right) meet in the end point, the head or the
//! tail. How they lean depends only on the squared distance `s` of the crank tips. The
//! margins need just two functions of `s`:
//!
//! ```text
//! rise = 2 height / distance    = sqrt((R - s) (s - N)) / s    R = (a + b)^2, N = (a - b)^2
//! skew = 2 foot / distance - 1  = (a^2 - b^2) / s              0 for equal couplers
//! ```
//!
//! (height and foot of the end point over the line, the foot counted from the left crank
//! tip; Heron's formula gives the height.) Both are read from a [`Curve`]. At either end
//! of its range the rise falls to zero like a square root, too steeply for a table over
//! `s`. There it is a function of the distance from that end, `R - s` or `s - N`, with
//! its own table. A robot that cannot reach that end does not have this table. The rise
//! is largest at `s = 2 R N / (R + N)`, below `2 N`; the table over `s` is read from
//! there on, where it falls, and stays at the largest rise below.

use core::mem::offset_of;

use lizard_avr::Flash;

use crate::curve::{Curve, ENTRIES, OCTAVES, Table, argument};

/// The tables of a pair of couplers. Q10.
#[derive(Clone, Copy, Debug)]
pub struct Tables<'a> {
    /// The rise over `s`, made by [`rise`].
    pub rise: Option<Flash<'a, Table>>,
    /// The rise over `R - s`, made by [`stretched`]; for a loop whose crank tips
    /// part so far that [`Couplers::is_near_stretched`].
    pub stretched: Option<Flash<'a, Table>>,
    /// The rise over `s - N`, made by [`folded`]; for couplers that
    /// [`Couplers::differ_much`].
    pub folded: Option<Flash<'a, Table>>,
    /// The skew over `s`, made by [`skew`]; for unequal couplers.
    pub skew: Option<Flash<'a, Table>>,
}

impl Tables<'_> {
    /// None at all: nothing is known of such couplers.
    pub const NONE: Self = Self {
        rise: None,
        stretched: None,
        folded: None,
        skew: None,
    };
}

lizard_avr::plain! {
    /// The lengths of two couplers of one loop, in its steps, and what follows from them.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Coupling {
        left: i16,
        right: i16,
        /// `R` in steps of `s`, a quarter of the bars' squared ones.
        reach_sq: u32,
        /// `N`, likewise.
        least_sq: u32,
        /// Leading zeros of both.
        reach_zeros: u16,
        least_zeros: u16,
    }
}

impl Coupling {
    /// Where the fields are, bytes from the beginning.
    pub(crate) const LEFT: usize = offset_of!(Self, left);
    pub(crate) const RIGHT: usize = offset_of!(Self, right);
    pub(crate) const REACH_SQ: usize = offset_of!(Self, reach_sq);
    pub(crate) const LEAST_SQ: usize = offset_of!(Self, least_sq);
    pub(crate) const REACH_ZEROS: usize = offset_of!(Self, reach_zeros);
    pub(crate) const LEAST_ZEROS: usize = offset_of!(Self, least_zeros);

    /// None: they never meet.
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
            least_sq: least_sq(left, right),
            reach_zeros: reach_sq(left, right).leading_zeros() as u16,
            least_zeros: least_sq(left, right).leading_zeros() as u16,
        }
    }

    /// Length of the left coupler.
    pub const fn left(&self) -> i16 {
        self.left
    }

    /// Length of the right coupler.
    pub const fn right(&self) -> i16 {
        self.right
    }

    /// See [`Couplers::differ_much`].
    pub const fn differs_much(&self) -> bool {
        2 * self.least_sq > self.reach_sq >> OCTAVES
    }
}

/// Two couplers of one loop, and the tables that belong to them.
#[derive(Clone, Copy)]
pub struct Couplers<'a> {
    lengths: Coupling,
    tables: Tables<'a>,
}

/// How the couplers lean at one distance of the crank tips, Q10.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lean {
    /// Twice the height of the end point over the distance of the crank tips.
    pub rise: i16,
    /// Twice the foot of that height over the distance, less one.
    pub skew: i16,
}

impl<'a> Couplers<'a> {
    /// Couplers of these lengths, in the steps of their loop, with the tables that
    /// belong to them; of what a table that is not there would tell, nothing is known.
    pub const fn new(lengths: Coupling, tables: Tables<'a>) -> Self {
        Self { lengths, tables }
    }

    /// True for couplers whose difference alone keeps the crank tips so far apart
    /// that the margins are known next to it: there the rise is read from the table
    /// of folded couplers. Of others, [`Couplers::at`] knows nothing so near.
    pub const fn differ_much(left: i16, right: i16) -> bool {
        Coupling::new(left, right).differs_much()
    }

    /// True where the squared distance of the crank tips is beyond three quarters
    /// of `R`: there the rise is read from the table of stretched couplers.
    pub const fn is_near_stretched(left: i16, right: i16, tips_sq: u32) -> bool {
        is_near_stretched(reach_sq(left, right), tips_sq)
    }

    /// The lean at a squared distance of the crank tips in steps of 1/4 of the
    /// bars' squared ones. None where the couplers do not close the loop, or so
    /// near to that, or to coinciding crank tips, that the type-2 margin is below
    /// a tenth, the least limit that a robot may have.
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
            _ => Curve::of_octave(tables.rise?, lengths.reach_zeros).falling(tips_sq)?,
        };
        let skew = match tables.skew {
            Some(skew) => {
                let size = Curve::of_octave(skew, lengths.reach_zeros).falling(tips_sq)?;
                if lengths.left < lengths.right {
                    size.wrapping_neg()
                } else {
                    size
                }
            }
            None => 0,
        };
        Some(Lean { rise, skew })
    }
}

/// See [`Couplers::is_near_stretched`].
const fn is_near_stretched(reach_sq: u32, tips_sq: u32) -> bool {
    tips_sq > reach_sq - reach_sq / 4
}

/// The rise over `s` for couplers of these lengths; made by a host.
pub const fn rise(left: i16, right: i16) -> Table {
    let (reach_sq, least_sq) = (reach_sq(left, right), least_sq(left, right));
    let mut table = [0; ENTRIES];
    let mut index = 0;
    while index < ENTRIES {
        // Rounded down, because a straight line between two points of this curve
        // lies above it.
        let mut tips_sq = argument(reach_sq, index);
        if tips_sq < peak_sq(left, right) as u64 {
            tips_sq = peak_sq(left, right) as u64;
        }
        table[index] = rise_q10(reach_sq, least_sq, tips_sq, 0);
        index += 1;
    }
    table
}

/// The rise over `R - s`; made by a host.
pub const fn stretched(left: i16, right: i16) -> Table {
    let (reach_sq, least_sq) = (reach_sq(left, right), least_sq(left, right));
    let mut table = [0; ENTRIES];
    let mut index = 0;
    while index < ENTRIES {
        let short = argument(reach_sq / 4, index);
        if short < reach_sq as u64 {
            table[index] = rise_q10(reach_sq, least_sq, reach_sq as u64 - short, 1);
        }
        index += 1;
    }
    table
}

/// The rise over `s - N`; made by a host.
pub const fn folded(left: i16, right: i16) -> Table {
    let (reach_sq, least_sq) = (reach_sq(left, right), least_sq(left, right));
    let mut table = [0; ENTRIES];
    let mut index = 0;
    while index < ENTRIES {
        let above = argument(least_sq, index);
        table[index] = rise_q10(reach_sq, least_sq, least_sq as u64 + above, 1);
        index += 1;
    }
    table
}

/// The size of the skew over `s`; made by a host.
pub const fn skew(left: i16, right: i16) -> Table {
    let reach_sq = reach_sq(left, right);
    // a^2 - b^2 in the steps of `s`, a quarter of the bars' squared ones.
    let difference = (left as i64 * left as i64 - right as i64 * right as i64).unsigned_abs() / 4;
    let mut table = [0; ENTRIES];
    let mut index = 0;
    while index < ENTRIES {
        let tips_sq = argument(reach_sq, index);
        let skew = ((difference << 10) + tips_sq / 2) / tips_sq;
        table[index] = if skew < 0x7fff { skew as i16 } else { 0x7fff };
        index += 1;
    }
    table
}

/// `sqrt((R - s)(s - N)) / s` in Q10, to nearest where `round` is 1, down where
/// it is 0; 0 outside of N..R.
const fn rise_q10(reach_sq: u32, least_sq: u32, tips_sq: u64, round: u128) -> i16 {
    let (reach_sq, least_sq) = (reach_sq as u64, least_sq as u64);
    if tips_sq >= reach_sq || tips_sq <= least_sq {
        return 0;
    }
    let product = (reach_sq - tips_sq) as u128 * (tips_sq - least_sq) as u128;
    // One bit more than Q10 for the rounding.
    let twice = ((product << 22) / (tips_sq as u128 * tips_sq as u128)).isqrt();
    let rise = (twice + round) >> 1;
    if rise < 0x7fff { rise as i16 } else { 0x7fff }
}

/// `R` in steps of `s`, a quarter of the bars' squared ones.
const fn reach_sq(left: i16, right: i16) -> u32 {
    let sum = left as u32 + right as u32;
    // Half of the sum squared; of equal couplers exactly the coupler squared.
    sum / 2 * (sum / 2) + if sum % 2 == 1 { sum / 2 } else { 0 }
}

/// `N` in steps of `s`.
const fn least_sq(left: i16, right: i16) -> u32 {
    let difference = left.abs_diff(right) as u32;
    difference * difference / 4
}

/// Where the rise is largest, in steps of `s`.
const fn peak_sq(left: i16, right: i16) -> u32 {
    let (reach_sq, least_sq) = (reach_sq(left, right) as u64, least_sq(left, right) as u64);
    (2 * reach_sq * least_sq / (reach_sq + least_sq)) as u32
}

const _: () = assert!(OCTAVES == 10, "1/1024 of R is a type-2 margin of .06");

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::five_bar::SHORTEST_COUPLER;
    use crate::sample::Bars;
    use crate::sample::bounds::{self, KNOWN};

    /// The longest coupler that a loop's step allows.
    const LONGEST: i16 = 32_511;

    /// Rise and skew of couplers of these lengths with their crank tips at the
    /// distance whose quarter square is `tips_sq`, straight from the triangle.
    fn truth(left: f64, right: f64, tips_sq: u32) -> Option<[f64; 2]> {
        let distance = 2.0 * f64::from(tips_sq).sqrt();
        let foot = (distance * distance + left * left - right * right) / (2.0 * distance);
        let height_sq = left * left - foot * foot;
        (height_sq >= 0.0).then(|| {
            let rise = 2.0 * height_sq.sqrt() / distance;
            [rise, 2.0 * foot / distance - 1.0]
        })
    }

    /// The type-2 margin: 2 a b sin = rise s.
    fn type2(left: f64, right: f64, tips_sq: u32, rise: f64) -> f64 {
        2.0 * rise * f64::from(tips_sq) / (left * right)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(6000))]

        #[test]
        fn the_lean_is_the_triangles_from_folded_to_stretched_couplers(
            shorter in SHORTEST_COUPLER..=LONGEST,
            longer in SHORTEST_COUPLER..=LONGEST,
            alike in 0u8..4,
            exchanged: bool,
            share in (0.0..1.0f64, 0u8..3),
        ) {
            // Equal, nearly equal, and any.
            let longer = match alike {
                0 => shorter,
                1 => shorter + (longer % 100).min(LONGEST - shorter),
                _ => longer,
            };
            let (left, right) = if exchanged { (longer, shorter) } else { (shorter, longer) };
            // Even over the range, and dense at either end.
            let share = match share {
                (share, 0) => share,
                (share, 1) => share.powi(4),
                (share, _) => 1.0 - share.powi(4),
            };
            let (reach, least) = (reach_sq(left, right), least_sq(left, right));
            let tips_sq = least + (f64::from(reach - least) * share) as u32;
            let bars = Bars::new(left, right);
            let lean = bars.couplers().at(tips_sq);
            let bound = bounds::Lean::of(left, right, [f64::from(tips_sq); 2]);
            let (left, right) = (f64::from(left), f64::from(right));
            // Rounded lengths may close a loop that the true ones leave open by a hair.
            let [rise, skew] = truth(left, right, tips_sq).unwrap_or([0.0, f64::NAN]);
            let Some(lean) = lean else {
                prop_assert!(type2(left, right, tips_sq, rise) < KNOWN, "a lean for {rise}");
                return Ok(());
            };
            let off = [
                f64::from(lean.rise) / 1024.0 - rise,
                f64::from(lean.skew) / 1024.0 - skew,
            ];
            prop_assert!(off[0] <= bound.rise, "rise {off:?}, {bound:?}");
            if type2(left, right, tips_sq, rise) < KNOWN {
                // An entry beyond the table's numbers is less than it should be.
                return Ok(());
            }
            prop_assert!(-off[0] <= bound.rise, "rise {off:?}, {bound:?}");
            // What floating point is off by.
            let hair = 1e-9;
            prop_assert!(skew.is_nan() || off[1].abs() <= bound.skew + hair, "skew {off:?}, {bound:?}");
            // Rounding alone never calls a skew the other way.
            prop_assert!(lean.skew == 0 || (lean.skew > 0) == (left > right));
        }

        #[test]
        fn couplers_that_do_not_meet_have_no_lean(
            left in SHORTEST_COUPLER..=LONGEST,
            right in SHORTEST_COUPLER..=LONGEST,
            beyond in 0u32..1 << 28,
        ) {
            let bars = Bars::new(left, right);
            let (reach, least) = (reach_sq(left, right), least_sq(left, right));
            prop_assert_eq!(bars.couplers().at(reach + beyond), None);
            prop_assert_eq!(bars.couplers().at(least.saturating_sub(beyond)), None);
        }
    }

    #[test]
    fn entries_are_rounded_to_nearest_but_those_of_a_falling_rise_down() {
        for (left, right) in [(12_800, 12_800), (13_000, 11_000), (9_000, 20_001)] {
            let (reach, least) = (reach_sq(left, right), least_sq(left, right));
            let tables = [
                rise(left, right),
                stretched(left, right),
                folded(left, right),
                skew(left, right),
            ];
            let exact = |tips_sq: u64| {
                let [r, n, s] = [reach.into(), least.into(), tips_sq].map(|sq: u64| sq as f64);
                (1024.0 * ((r - s) * (s - n)).sqrt() / s).min(32_767.0)
            };
            let within = |tips_sq: u64| (u64::from(least) + 1..u64::from(reach)).contains(&tips_sq);
            for index in 0..ENTRIES {
                let [falling, stretched, folded, skew] =
                    tables.map(|table| f64::from(table[index]));
                let tips_sq = argument(reach, index);
                if within(tips_sq) && tips_sq >= peak_sq(left, right).into() {
                    assert!(
                        (0.0..1.0).contains(&(exact(tips_sq) - falling)),
                        "rise {index}"
                    );
                }
                let difference = (f64::from(left).powi(2) - f64::from(right).powi(2)) / 4.0;
                let exact_skew = 1024.0 * difference.abs() / tips_sq as f64;
                assert!(
                    (skew - exact_skew.min(32_767.0)).abs() <= 0.51,
                    "skew {index}"
                );
                let tips_sq = u64::from(reach).saturating_sub(argument(reach / 4, index));
                if within(tips_sq) {
                    assert!(
                        (stretched - exact(tips_sq)).abs() <= 0.51,
                        "stretched {index}"
                    );
                }
                let tips_sq = u64::from(least) + argument(least, index);
                if within(tips_sq) {
                    assert!((folded - exact(tips_sq)).abs() <= 0.51, "folded {index}");
                }
            }
        }
    }

    #[test]
    fn couplers_that_differ_by_a_few_steps_are_couplers_too() {
        for more in 0..300 {
            let bars = Bars::new(12_800, 12_800 + more);
            for tips_sq in [1 << 20, 1 << 24, 1 << 27] {
                let lean = bars.couplers().at(tips_sq).expect("closes");
                let [rise, _] =
                    truth(12_800.0, 12_800.0 + f64::from(more), tips_sq).expect("closes");
                let off = f64::from(lean.rise) / 1024.0 - rise;
                assert!(
                    off.abs() <= 0.002 * rise.max(1.0),
                    "{more}: {off} of {rise}"
                );
            }
        }
    }

    #[test]
    fn a_loop_is_near_stretched_beyond_three_quarters_of_its_squared_reach() {
        let reach = reach_sq(20_000, 30_000);
        let limit = reach - reach / 4;
        assert!(!Couplers::is_near_stretched(20_000, 30_000, limit));
        assert!(Couplers::is_near_stretched(20_000, 30_000, limit + 1));
    }
}
