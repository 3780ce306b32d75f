//! The tables of the couplers, compared with triangles in floating point.

use proptest::prelude::*;

use super::*;
use crate::numbers::bars::MIN_COUPLER;
use crate::numbers::curve::ENTRIES;
use crate::sample::SampleCouplers;
use crate::sample::bounds::{self, MIN_KNOWN_MARGIN};

/// The longest coupler that a loop's step allows.
const MAX_COUPLER: i16 = 32_511;

/// Computes rise and skew of couplers of these lengths directly from the triangle, with their crank tips at a
/// distance whose squared half is `tips_sq`.
fn exact_lean(left: f64, right: f64, tips_sq: u32) -> Option<[f64; 2]> {
    let distance = 2.0 * f64::from(tips_sq).sqrt();
    let foot = (distance * distance + left * left - right * right) / (2.0 * distance);
    let height_sq = left * left - foot * foot;
    (height_sq >= 0.0).then(|| {
        let rise = 2.0 * height_sq.sqrt() / distance;
        [rise, 2.0 * foot / distance - 1.0]
    })
}

/// The type-2 margin for a rise: 2 a b sin = rise s.
fn type2_of(left: f64, right: f64, tips_sq: u32, rise: f64) -> f64 {
    2.0 * rise * f64::from(tips_sq) / (left * right)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6000))]

    #[test]
    fn the_lean_is_the_triangles_from_folded_to_stretched_couplers(
        shorter in MIN_COUPLER..=MAX_COUPLER,
        longer in MIN_COUPLER..=MAX_COUPLER,
        likeness in 0u8..4,
        is_exchanged: bool,
        share in (0.0..1.0f64, 0u8..3),
    ) {
        // Equal lengths, nearly equal ones, and any.
        let longer = match likeness {
            0 => shorter,
            1 => shorter + (longer % 100).min(MAX_COUPLER - shorter),
            _ => longer,
        };
        let (left, right) = if is_exchanged { (longer, shorter) } else { (shorter, longer) };
        // Even over the range, or dense at one of its ends.
        let share = match share {
            (share, 0) => share,
            (share, 1) => share.powi(4),
            (share, _) => 1.0 - share.powi(4),
        };
        let (reach, min) = (reach_sq(left, right), folded_sq(left, right));
        let tips_sq = min + (f64::from(reach - min) * share) as u32;
        let bars = SampleCouplers::new(left, right);
        let lean = bars.couplers().at(tips_sq);
        let bound = bounds::LeanError::of(left, right, [f64::from(tips_sq); 2]);
        let (left, right) = (f64::from(left), f64::from(right));
        // A loop that just fails to close may close with rounded lengths.
        let [rise, skew] = exact_lean(left, right, tips_sq).unwrap_or([0.0, f64::NAN]);
        let Some(lean) = lean else {
            prop_assert!(type2_of(left, right, tips_sq, rise) < MIN_KNOWN_MARGIN, "a lean for {rise}");
            return Ok(());
        };
        let error = [
            f64::from(lean.rise) / 1024.0 - rise,
            f64::from(lean.skew) / 1024.0 - skew,
        ];
        if type2_of(left, right, tips_sq, rise) < MIN_KNOWN_MARGIN {
            // An entry above the largest number of a table is cut off, and below its peak the table keeps the largest
            // rise. No value there may give a margin above the threshold.
            let min_rise = f64::from(lean.rise) / 1024.0 - bound.rise;
            prop_assert!(type2_of(left, right, tips_sq, min_rise) < MIN_KNOWN_MARGIN, "rise {error:?}, {bound:?}");
            return Ok(());
        }
        prop_assert!(error[0].abs() <= bound.rise, "rise {error:?}, {bound:?}");
        // The rounding of the floating-point reference.
        let tolerance = 1e-9;
        prop_assert!(skew.is_nan() || error[1].abs() <= bound.skew + tolerance, "skew {error:?}, {bound:?}");
        // Rounding never changes the sign of a skew.
        prop_assert!(lean.skew == 0 || (lean.skew > 0) == (left > right));
    }

    #[test]
    fn couplers_that_do_not_meet_have_no_lean(
        left in MIN_COUPLER..=MAX_COUPLER,
        right in MIN_COUPLER..=MAX_COUPLER,
        excess_sq in 0u32..1 << 28,
    ) {
        let bars = SampleCouplers::new(left, right);
        let (reach, min) = (reach_sq(left, right), folded_sq(left, right));
        prop_assert_eq!(bars.couplers().at(reach + excess_sq), None);
        prop_assert_eq!(bars.couplers().at(min.saturating_sub(excess_sq)), None);
    }
}

#[test]
fn entries_are_rounded_to_nearest_but_those_of_a_falling_rise_down() {
    for (left, right) in [(12_800, 12_800), (13_000, 11_000), (9_000, 20_001)] {
        let (reach, min) = (reach_sq(left, right), folded_sq(left, right));
        let tables = [
            rise(left, right),
            stretched(left, right),
            folded(left, right),
            skew(left, right),
        ];
        let exact_rise_at = |tips_sq: u64| {
            let [r, n, s] = [reach.into(), min.into(), tips_sq].map(|sq: u64| sq as f64);
            (1024.0 * ((r - s) * (s - n)).sqrt() / s).min(32_767.0)
        };
        let is_within_range =
            |tips_sq: u64| (u64::from(min) + 1..u64::from(reach)).contains(&tips_sq);
        for index in 0..ENTRIES {
            let [falling_entry, stretched_entry, folded_entry, skew_entry] =
                tables.map(|table| f64::from(table[index]));
            let tips_sq = argument(reach, index);
            if is_within_range(tips_sq) && tips_sq >= peak_sq(left, right).into() {
                assert!(
                    (0.0..1.0).contains(&(exact_rise_at(tips_sq) - falling_entry)),
                    "rise {index}"
                );
            }
            let difference = (f64::from(left).powi(2) - f64::from(right).powi(2)) / 4.0;
            let exact_skew = 1024.0 * difference.abs() / tips_sq as f64;
            assert!(
                (skew_entry - exact_skew.min(32_767.0)).abs() <= 0.51,
                "skew {index}"
            );
            let tips_sq = u64::from(reach).saturating_sub(argument(reach / 4, index));
            if is_within_range(tips_sq) {
                assert!(
                    (stretched_entry - exact_rise_at(tips_sq)).abs() <= 0.51,
                    "stretched {index}"
                );
            }
            let tips_sq = u64::from(min) + argument(min, index);
            if is_within_range(tips_sq) {
                assert!(
                    (folded_entry - exact_rise_at(tips_sq)).abs() <= 0.51,
                    "folded {index}"
                );
            }
        }
    }
}

#[test]
fn couplers_that_differ_by_a_few_steps_are_couplers_too() {
    for extra_steps in 0..300 {
        let bars = SampleCouplers::new(12_800, 12_800 + extra_steps);
        for tips_sq in [1 << 20, 1 << 24, 1 << 27] {
            let lean = bars.couplers().at(tips_sq).expect("closes");
            let [rise, _] =
                exact_lean(12_800.0, 12_800.0 + f64::from(extra_steps), tips_sq).expect("closes");
            let error = f64::from(lean.rise) / 1024.0 - rise;
            assert!(
                error.abs() <= 0.002 * rise.max(1.0),
                "{extra_steps}: {error} of {rise}"
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
