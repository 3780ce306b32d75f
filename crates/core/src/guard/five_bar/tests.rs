//! Compares the integer margins of a five-bar with the closed form in floating point.

use lizard_kinematics as kinematics;
use proptest::prelude::*;

use super::*;
use crate::guard::bounds::{self, MarginErrors};
use crate::numbers::units::Angle;
use crate::sample::{SampleFiveBar, to_degrees, to_f64};

/// Yields random five-bars, in mm, whose couplers are long enough for the other links.
fn any_five_bar() -> impl Strategy<Value = kinematics::FiveBar> {
    let lengths = [0.0..100.0, 1.0..100.0, 5.0..120.0, 5.0..120.0, 1.0..100.0];
    (lengths, 0u8..3)
        .prop_map(|(lengths, variant)| {
            let mut five_bar = kinematics::FiveBar::new(lengths);
            five_bar.right_coupler_length = match variant {
                0 => five_bar.left_coupler_length,
                1 => five_bar.left_coupler_length + five_bar.base / 500.0,
                _ => five_bar.right_coupler_length,
            };
            five_bar
        })
        .prop_filter("the couplers are long enough", |five_bar| {
            SampleFiveBar::new(five_bar).is_some()
        })
}

fn compute_margins(sample: &SampleFiveBar, angles: [Angle; 2]) -> EndMargins {
    let [left, right] = angles.map(Direction::from_angle);
    sample.five_bar().margins(&left, &right)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn margins_of_random_five_bars_are_within_their_error_bounds(
        five_bar in any_five_bar(),
        left: u16,
        right: u16,
    ) {
        let angles = [left, right].map(Angle);
        let sample = SampleFiveBar::new(&five_bar).expect("the lengths fit the integers");
        let actual = compute_margins(&sample, angles);
        let angles = angles.map(to_degrees);
        let bound = MarginErrors::at_angles(&five_bar, &sample.lengths, angles);
        let Ok(pose) = five_bar.forward(angles[0], angles[1]) else {
            // Couplers that just fail to meet may meet once their lengths are rounded to whole steps.
            prop_assert!(to_f64(actual.type2).abs() <= bound.type2, "{actual:?}");
            return Ok(());
        };
        let actual_type2 = to_f64(actual.type2).abs();
        let error = actual_type2 - pose.type2;
        // Where the tables have no correct value, a small margin may also be too large.
        let may_be_overstated = !bound.do_bounds_hold && actual_type2 <= bounds::MAX_OVERSTATED_MARGIN;
        prop_assert!(error <= bound.type2 || may_be_overstated, "type-2 error {error}: {bound:?}");
        if actual == EndMargins::default() {
            // Margins of zero are reported as "below 0.1", so the true type-2 margin must be below 0.1.
            prop_assert!(pose.type2 < 0.1, "no margins at a type-2 margin of {}", pose.type2);
        }
        if !bound.do_bounds_hold {
            // The tables may have no value here, so the margin may be too small, or all margins may be zero.
            return Ok(());
        }
        prop_assert_ne!(actual, EndMargins::default());
        prop_assert!(-error <= bound.type2, "type-2 error {error}: {bound:?}");
        if pose.gap.x.abs() > bound.gap_x && pose.type2 > bound.type2 {
            prop_assert_eq!(actual.type2.0 > 0, pose.gap.x > 0.0, "{:?} {:?}", actual, pose);
        }
        for (side, actual, exact, bound) in [
            ("left", actual.type1_left, pose.type1_left(), bound.type1_left),
            ("right", actual.type1_right, pose.type1_right(), bound.type1_right),
        ] {
            let error = to_f64(actual) - exact;
            prop_assert!(error.abs() <= bound, "type-1, {side}: error {error}, at most {bound} allowed");
        }
    }
}

/// A search over random lengths found these five-bars, with short couplers at a small type-2 margin, where rounding a
/// length by one step turns the couplers most.
#[test]
fn the_largest_known_errors_are_within_their_bounds() {
    for (lengths, angles, known_error) in [
        (
            [
                85.13013589423028,
                55.8942949166095,
                59.23188086336843,
                32.53652686467961,
                49.608614531886445,
            ],
            [33_517, 32_153],
            0.009,
        ),
        (
            [
                67.09941045998794,
                22.824664415709368,
                20.674382303104537,
                20.674382303104537,
                7.276714999964176,
            ],
            [64_009, 22_963],
            0.0089,
        ),
    ] {
        let five_bar = kinematics::FiveBar::new(lengths);
        let sample = SampleFiveBar::new(&five_bar).expect("the lengths fit the integers");
        let angles = angles.map(Angle);
        let actual = compute_margins(&sample, angles);
        let [left, right] = angles.map(to_degrees);
        let bound = MarginErrors::at_angles(&five_bar, &sample.lengths, [left, right]);
        let pose = five_bar.forward(left, right).expect("the loop closes");
        let error = (to_f64(actual.type2).abs() - pose.type2).abs();
        // The five-bar must still have the error for which it was chosen.
        assert!(error > known_error && pose.type2 > 0.1, "{error}");
        let is_narrow = bound.type2 < 2.5 * error;
        assert!(error <= bound.type2 && is_narrow, "{error}: {bound:?}");
    }
}

#[test]
fn rounding_does_not_bias_a_type_2_margin_with_few_bits() {
    // The crank tips are close and the couplers are long. Therefore the squared distance is small, and its rounding is
    // relatively large.
    let five_bar = kinematics::FiveBar::new([20.0, 30.0, 126.0, 126.0, 30.0]);
    let sample = SampleFiveBar::new(&five_bar).expect("the lengths fit the integers");
    let (mut error_sum, mut count) = (0.0, 0.0);
    for left in (13_000..18_000).step_by(7) {
        let angles = [left, 0x8000 - left].map(Angle);
        let [left, right] = angles.map(to_degrees);
        let pose = five_bar.forward(left, right).expect("the loop closes");
        let actual = to_f64(compute_margins(&sample, angles).type2);
        if pose.gap.x > 0.0 && pose.type2 > 0.1 && pose.type2 < 0.3 {
            error_sum += actual - pose.type2;
            count += 1.0;
        }
    }
    assert!(count > 100.0);
    assert!(f64::abs(error_sum / count) < 3e-4, "{}", error_sum / count);
}

#[test]
fn couplers_that_do_not_meet_have_no_margins_and_crossed_crank_tips_a_negative_one() {
    let five_bar = kinematics::FiveBar::new([20.0, 30.0, 40.0, 35.0, 30.0]);
    let sample = SampleFiveBar::new(&five_bar).expect("the lengths fit the integers");
    let margins_at = |angles: [i32; 2]| compute_margins(&sample, angles.map(Angle::from_centideg));
    // Both cranks point outward: the distance between their tips is 80 mm, more than the couplers reach.
    assert_eq!(margins_at([18_000, 0]), EndMargins::default());
    // The cranks cross, so the couplers close the loop upside down.
    assert!(margins_at([6_000, 12_000]).type2 < Sine(0));
}
