//! The scale of a mechanism's lengths: the finest step with which the longest links still fit into the core's 16-bit
//! integers.

use lizard_core::numbers::units::Scale;
use lizard_core::numbers::{link_lengths, slider};
use lizard_kinematics::{FiveBar, Slider};

/// Largest link length that robot.toml may contain, mm.
pub(crate) const MAX_LINK_LENGTH_MM: f64 = 1000.0;

// Every mechanism that robot.toml may describe fits at a scale.
const _: () = assert!(3.0 * MAX_LINK_LENGTH_MM < link_lengths::MAX_LENGTH_STEPS);
const _: () = assert!(4.0 * MAX_LINK_LENGTH_MM < slider::MAX_ARM_STEPS);

/// The number of steps per millimetre at a scale.
pub(crate) fn steps_per_mm(scale: Scale) -> f64 {
    f64::from(1u32 << scale.bits)
}

/// Finds the finest scale for the five-bar of the head or the tail.
pub(crate) fn find_five_bar_scale(five_bar: &FiveBar) -> Scale {
    let base_and_cranks = five_bar.base + five_bar.left_crank_length + five_bar.right_crank_length;
    let [left, right] = [five_bar.left_coupler_length, five_bar.right_coupler_length];
    let lengths = [base_and_cranks, left, right];
    find_finest_scale(&lengths.map(|mm| (mm, link_lengths::MAX_LENGTH_STEPS)))
}

/// Finds the finest scale for a slider that may extend `stroke_max` mm beyond its nominal length.
pub(crate) fn find_slider_scale(slider_loop: &Slider, stroke_max: f64) -> Scale {
    let arms = slider_loop.front_arm + slider_loop.rear_arm + slider_loop.front_offset.abs();
    let max_length = slider_loop.nominal_length + stroke_max.max(0.0);
    find_finest_scale(&[
        (slider_loop.base + arms, slider::MAX_LENGTH_STEPS),
        (arms, slider::MAX_ARM_STEPS),
        (max_length, slider::MAX_LENGTH_STEPS),
    ])
}

/// Finds the finest scale at which each length (mm) has fewer steps than its bound.
fn find_finest_scale(lengths: &[(f64, f64)]) -> Scale {
    let fits = |scale: &Scale| {
        let steps_per_mm = steps_per_mm(*scale);
        lengths.iter().all(|(mm, bound)| mm * steps_per_mm < *bound)
    };
    let mut scales = (0..=Scale::FINEST.bits).rev().map(|bits| Scale { bits });
    let finest_scale = scales.find(fits);
    finest_scale.expect("a link is at most a metre long")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// True if a five-bar fits at a scale of this number of bits, according to the core's bound of 127 x 256 steps.
    fn five_bar_fits(five_bar: &FiveBar, bits: u16) -> bool {
        let max_mm = 127.0 * 256.0 / f64::from(1u32 << bits);
        five_bar.base + five_bar.left_crank_length + five_bar.right_crank_length < max_mm
            && five_bar.left_coupler_length < max_mm
            && five_bar.right_coupler_length < max_mm
    }

    /// True if a slider fits at a scale of this number of bits, according to the core's bounds of 127 x 256 and 255 x
    /// 256 steps.
    fn slider_fits(slider: &Slider, stroke_max: f64, bits: u16) -> bool {
        let to_steps = |mm: f64| mm * f64::from(1u32 << bits);
        let arms = slider.front_arm + slider.rear_arm + slider.front_offset.abs();
        to_steps(arms) < 127.0 * 256.0
            && to_steps(slider.base + arms) < 255.0 * 256.0
            && to_steps(slider.nominal_length + stroke_max) < 255.0 * 256.0
    }

    /// Lengths of 1 to 1000 mm, evenly distributed on a logarithmic scale.
    fn any_length() -> impl Strategy<Value = f64> {
        (0.0..3.0f64).prop_map(|exponent| 10f64.powf(exponent))
    }

    proptest! {
        #[test]
        fn a_five_bar_has_the_finest_scale_that_fits(
            lengths in prop::array::uniform5(any_length()),
        ) {
            let five_bar = FiveBar::new(lengths);
            let bits = find_five_bar_scale(&five_bar).bits;
            prop_assert!(five_bar_fits(&five_bar, bits));
            prop_assert!(bits == 14 || !five_bar_fits(&five_bar, bits + 1), "{bits} bits");
        }

        #[test]
        fn a_slider_has_the_finest_scale_that_fits(
            [base, front_arm, rear_arm, nominal_length, stroke] in prop::array::uniform5(any_length()),
            front_offset in -500.0..500.0f64,
        ) {
            let slider = Slider { front_offset, base, front_arm, rear_arm, nominal_length };
            let bits = find_slider_scale(&slider, stroke).bits;
            prop_assert!(slider_fits(&slider, stroke, bits));
            prop_assert!(bits == 14 || !slider_fits(&slider, stroke, bits + 1), "{bits} bits");
        }
    }

    #[test]
    fn a_sum_of_lengths_at_the_bound_halves_the_steps_per_mm() {
        // With a base of 47 mm, base and cranks add up to 127 mm. This is exactly the bound at 256 steps per mm, so a
        // coarser scale is needed.
        let five_bar_with_base = |base| FiveBar::new([base, 40.0, 60.0, 60.0, 40.0]);
        assert_eq!(find_five_bar_scale(&five_bar_with_base(46.99)).bits, 8);
        assert_eq!(find_five_bar_scale(&five_bar_with_base(47.0)).bits, 7);
    }

    #[test]
    fn the_smallest_and_the_largest_robot_have_a_scale() {
        let equal_five_bar = |mm| FiveBar::new([mm; 5]);
        for (mm, bits) in [(1.0, 13), (MAX_LINK_LENGTH_MM, 3)] {
            assert_eq!(find_five_bar_scale(&equal_five_bar(mm)).bits, bits);
        }
    }
}
