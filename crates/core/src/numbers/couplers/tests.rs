//! Compares the couplers' tables with triangles in floating point.

use proptest::prelude::*;

use super::*;
use crate::guard::bounds::{self, MIN_BOUNDED_MARGIN};
use crate::numbers::curve::ENTRY_COUNT;
use crate::numbers::link_lengths::MIN_COUPLER_STEPS;
use crate::sample::SampleCouplers;

/// The longest coupler that the scale of a five-bar allows, in steps.
const MAX_COUPLER_STEPS: i16 = 32_511;

/// Computes the rise and the skew of couplers of these lengths directly from the triangle. `tips_sq` is the square of
/// half the distance between the crank tips. Returns `None` if the couplers do not meet.
fn compute_exact_shape(left: f64, right: f64, tips_sq: u32) -> Option<[f64; 2]> {
    let distance = 2.0 * f64::from(tips_sq).sqrt();
    let foot = (distance * distance + left * left - right * right) / (2.0 * distance);
    let height_sq = left * left - foot * foot;
    (height_sq >= 0.0).then(|| {
        let rise = 2.0 * height_sq.sqrt() / distance;
        [rise, 2.0 * foot / distance - 1.0]
    })
}

/// Computes the type-2 margin from a rise, according to `2 a b sin = rise s`.
fn compute_type2_margin(left: f64, right: f64, tips_sq: u32, rise: f64) -> f64 {
    2.0 * rise * f64::from(tips_sq) / (left * right)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6000))]

    #[test]
    fn the_shape_is_that_of_the_triangle_from_folded_to_stretched_couplers(
        first_length in MIN_COUPLER_STEPS..=MAX_COUPLER_STEPS,
        second_length in MIN_COUPLER_STEPS..=MAX_COUPLER_STEPS,
        length_variant in 0u8..4,
        is_swapped: bool,
        fraction_and_density in (0.0..1.0f64, 0u8..3),
    ) {
        // Equal lengths, nearly equal ones, or any.
        let second_length = match length_variant {
            0 => first_length,
            1 => first_length + (second_length % 100).min(MAX_COUPLER_STEPS - first_length),
            _ => second_length,
        };
        let (left, right) = if is_swapped { (second_length, first_length) } else { (first_length, second_length) };
        // Evenly distributed over the range, or dense at one of its ends.
        let fraction = match fraction_and_density {
            (fraction, 0) => fraction,
            (fraction, 1) => fraction.powi(4),
            (fraction, _) => 1.0 - fraction.powi(4),
        };
        let [reach_sq, folded_sq] = compute_limits_sq(left, right);
        let tips_sq = folded_sq + (f64::from(reach_sq - folded_sq) * fraction) as u32;
        let sample = SampleCouplers::new(left, right);
        let shape = sample.couplers().shape_at(tips_sq);
        let bound = bounds::ShapeError::compute(left, right, [f64::from(tips_sq); 2]);
        let (left, right) = (f64::from(left), f64::from(right));
        // A loop that just fails to close may close when its lengths are rounded.
        let [rise, skew] = compute_exact_shape(left, right, tips_sq).unwrap_or([0.0, f64::NAN]);
        let Some(shape) = shape else {
            let margin = compute_type2_margin(left, right, tips_sq, rise);
            prop_assert!(margin < MIN_BOUNDED_MARGIN, "no shape for a rise of {rise}");
            return Ok(());
        };
        let rise_error = f64::from(shape.rise) / 1024.0 - rise;
        let skew_error = f64::from(shape.skew) / 1024.0 - skew;
        if compute_type2_margin(left, right, tips_sq, rise) < MIN_BOUNDED_MARGIN {
            // A rise above the largest entry of a table is cut off, and below the peak the table holds the largest
            // rise. No such value may result in a margin above the threshold.
            let min_rise = f64::from(shape.rise) / 1024.0 - bound.rise;
            let margin = compute_type2_margin(left, right, tips_sq, min_rise);
            prop_assert!(margin < MIN_BOUNDED_MARGIN, "rise error {rise_error}, {bound:?}");
            return Ok(());
        }
        prop_assert!(rise_error.abs() <= bound.rise, "rise error {rise_error}, {bound:?}");
        // The rounding error of the floating-point reference.
        let tolerance = 1e-9;
        prop_assert!(skew.is_nan() || skew_error.abs() <= bound.skew + tolerance, "skew error {skew_error}, {bound:?}");
        // Rounding never changes the sign of a skew.
        prop_assert!(shape.skew == 0 || (shape.skew > 0) == (left > right));
    }

    #[test]
    fn couplers_that_do_not_meet_have_no_shape(
        left in MIN_COUPLER_STEPS..=MAX_COUPLER_STEPS,
        right in MIN_COUPLER_STEPS..=MAX_COUPLER_STEPS,
        excess_sq in 0u32..1 << 28,
    ) {
        let sample = SampleCouplers::new(left, right);
        let [reach_sq, folded_sq] = compute_limits_sq(left, right);
        prop_assert_eq!(sample.couplers().shape_at(reach_sq + excess_sq), None);
        prop_assert_eq!(sample.couplers().shape_at(folded_sq.saturating_sub(excess_sq)), None);
    }
}

#[test]
fn table_entries_are_rounded_to_nearest_but_the_falling_rise_is_rounded_down() {
    for (left, right) in [(12_800, 12_800), (13_000, 11_000), (9_000, 20_001)] {
        let [reach_sq, folded_sq] = compute_limits_sq(left, right);
        let tables = [
            compute_rise_table(left, right),
            compute_stretched_rise_table(left, right),
            compute_folded_rise_table(left, right),
            compute_skew_table(left, right),
        ];
        let exact_rise_q10 = |tips_sq: u64| {
            let [r, n, s] = [reach_sq.into(), folded_sq.into(), tips_sq].map(|sq: u64| sq as f64);
            (1024.0 * ((r - s) * (s - n)).sqrt() / s).min(32_767.0)
        };
        let is_within_range =
            |tips_sq: u64| (u64::from(folded_sq) + 1..u64::from(reach_sq)).contains(&tips_sq);
        for index in 0..ENTRY_COUNT {
            let [falling_entry, stretched_entry, folded_entry, skew_entry] =
                tables.map(|table| f64::from(table[index]));
            let tips_sq = argument_at(reach_sq, index);
            if is_within_range(tips_sq) && tips_sq >= compute_peak_sq(left, right).into() {
                let error = exact_rise_q10(tips_sq) - falling_entry;
                assert!((0.0..1.0).contains(&error), "rise {index}");
            }
            let difference = (f64::from(left).powi(2) - f64::from(right).powi(2)) / 4.0;
            let exact_skew_q10 = 1024.0 * difference.abs() / tips_sq as f64;
            let error = skew_entry - exact_skew_q10.min(32_767.0);
            assert!(error.abs() <= 0.51, "skew {index}");
            let tips_sq = u64::from(reach_sq).saturating_sub(argument_at(reach_sq / 4, index));
            if is_within_range(tips_sq) {
                let error = stretched_entry - exact_rise_q10(tips_sq);
                assert!(error.abs() <= 0.51, "stretched {index}");
            }
            let tips_sq = u64::from(folded_sq) + argument_at(folded_sq, index);
            if is_within_range(tips_sq) {
                let error = folded_entry - exact_rise_q10(tips_sq);
                assert!(error.abs() <= 0.51, "folded {index}");
            }
        }
    }
}

#[test]
fn the_rise_is_accurate_for_couplers_of_nearly_equal_length() {
    for extra_steps in 0..300 {
        let sample = SampleCouplers::new(12_800, 12_800 + extra_steps);
        for tips_sq in [1 << 20, 1 << 24, 1 << 27] {
            let shape = sample.couplers().shape_at(tips_sq);
            let shape = shape.expect("the loop closes");
            let right = 12_800.0 + f64::from(extra_steps);
            let exact_shape = compute_exact_shape(12_800.0, right, tips_sq);
            let [rise, _] = exact_shape.expect("the loop closes");
            let error = f64::from(shape.rise) / 1024.0 - rise;
            let case = std::format!("{extra_steps} steps: error {error} of {rise}");
            assert!(error.abs() <= 0.002 * rise.max(1.0), "{case}");
        }
    }
}

#[test]
fn a_loop_is_near_stretched_beyond_three_quarters_of_its_squared_reach() {
    let [reach_sq, _] = compute_limits_sq(20_000, 30_000);
    let limit_sq = reach_sq - reach_sq / 4;
    assert!(!Couplers::is_near_stretched(20_000, 30_000, limit_sq));
    assert!(Couplers::is_near_stretched(20_000, 30_000, limit_sq + 1));
}
