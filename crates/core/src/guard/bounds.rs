//! Proved bounds on the difference between integer and floating-point results.
//!
//! Each bound is the sum of the largest effects of all roundings that lead to a result. The parts below follow the
//! order of the calculation. Only the errors of the sines of [`crate::guard::trig`] are measured: a test of that module
//! compares the sines at every angle. If a test finds an error beyond its bound, the code or this derivation is wrong.
//!
//! Lengths of a five-bar (head or tail) are in `U`, two steps of its links' scale; the code computes the distance
//! between the crank tips in this unit. `k` is the vector from the left crank tip to the right one, `s = k^2`, `c1` and
//! `c2` are the lengths of the cranks, `a` and `b` those of the couplers, `R = (a + b)^2`, `N = (a - b)^2`. Rise and
//! skew are defined in [`crate::numbers::couplers`], the margins in [`crate::guard::five_bar`]. A prime, as in `k'`,
//! marks the integer result for a true value.
//!
//! **1. Crank tips.** Base and cranks are rounded to whole steps, which changes each by at most 1/4 U. Halving the base
//! has an error of at most 1/2 U, rounding the sum of the products of at most 1/2 U, and the sine and cosine of a
//! direction have an error of at most `d`, [`MAX_DIRECTION_ERROR`]. So `k'` is within `e = hypot(e_x, e_y)` of `k`:
//!
//! ```text
//! e_x = 1/4 + 1/2 + 1/2 + (|cos left| + |cos right|) / 4 + d (c1 + c2)
//! e_y =             1/2 + (|sin left| + |sin right|) / 4 + d (c1 + c2)
//! ```
//!
//! **2. The triangle.** The angle `gamma` between the couplers has the cosine `c = (a^2 + b^2 - s) / 2ab`. If the
//! couplers have the errors `x` and `y`, at most 1/4 U each, and `s` has the error `z`,
//!
//! ```text
//! c' - c = (2x (a - b c) + 2y (b - a c) + x^2 + y^2 - 2xyc - z) / 2a'b'
//! ```
//!
//! where `a - b c` is the component of `k` along the left coupler, and `b - a c` along the right one, so both are at
//! most `|k|`. As `sin^2 = 1 - cos^2`, a sine `m` changes to a sine between the square roots of `m^2 - q` and of
//! `m^2 + q`, with `q = |c' - c| (2 |c| + |c' - c|)`.
//!
//! The angle at a crank tip changes by at most `(|x| + |y| + e) / (a sin(gamma))`. This follows from the derivative of
//! the triangle's angle with respect to its sides, along a straight path from one triangle to the other; on this path
//! the sine is at least the lower root. The line `k` itself turns by at most `asin(e / |k|)`.
//!
//! **3. The tables.** See [`ShapeError`].
//!
//! **4. The products** of [`crate::guard::five_bar`]: the rounded square has an error of half its unit, each shift an
//! error of at most one unit of its result, and each reciprocal an error of less than one of its units.
//!
//! **5. A range.** For a set of many pairs of angles, only the range of the distance `|k|` is known, `[near, far]`;
//! sines and cosines in `e` are at most 1. Each term above is taken where it is largest: `z`, `|k|` and terms that
//! increase with the distance at `far`, terms with the distance in the denominator at `near`. As `|k|` increases, `c`
//! decreases, so `|c|` is largest at an end of the range. At that end the sine is smallest, and its difference from the
//! two roots is largest. The largest sine is at an end of the range, too, unless `c` changes its sign within the range.
//! A single pair of angles is a range of width 0.

use lizard_kinematics as kinematics;
use lizard_kinematics::Vector;

use crate::numbers::section::FiveBarLengths;
use crate::numbers::slider::Slider;
use crate::numbers::units::Scale;

/// The largest error of a sine or a cosine; a test of [`crate::guard::trig`] checks it at every angle.
pub const MAX_DIRECTION_ERROR: f64 = 4.5e-5;

/// The unit of a margin, a number in Q15.
pub const Q15_UNIT: f64 = 1.0 / 32768.0;

/// The unit of a value read from a table, a number in Q10.
const Q10_UNIT: f64 = 1.0 / 1024.0;

/// The type-2 margin below which the tables may have no correct value. The lower limit of a table's argument determines
/// the largest margin, a sine, at which the value is missing:
///
/// - The table over `R - s` ends at `R / 4096`. The sine there is `sqrt((R - s)(s - N)) / 2ab`, which is below
///   `sqrt(4ab R / 4096) / 2ab`: at most 0.05 with couplers of a ratio of 8, the largest possible ratio.
/// - The table over `s - N` ends at `N / 1024`, where the sine is at most 0.077.
/// - The table over `s` ends at `R / 1024`, where the sine is at most 0.063, because this part is read only if
///   `N < R / 2048`.
///
/// In two cases the tables have a value, but a wrong one. A rise above 32, the largest value of an entry, is cut off,
/// so the value is too small; an interval at whose beginning the rise is 32 ends at `17/16 R / 1024`, where the sine is
/// at most 0.065. For couplers of nearly equal length, the table over `s` holds the largest rise at all arguments below
/// the peak, so the value is too large (see [`MAX_OVERSTATED_MARGIN`]).
///
/// Where the tables have no correct value, the true margin is below a tenth: by part 2 of the derivation, it is at most
/// the square root of `m'^2 + q`. With the shortest couplers, of 2048 U, and `e` at most 3.1, `q` is at most
/// `7.3 |k| / ab`: 0.0071 for stretched couplers of equal length, where `m'` is 0.031, and 0.0031 for folded couplers
/// of a ratio of 8, where `m'` is 0.077.
pub const MIN_BOUNDED_MARGIN: f64 = 0.08;

/// The largest type-2 margin, a sine, that results from a value of the tables that is too large (see
/// [`MIN_BOUNDED_MARGIN`]). It is so small because the peak of the table over `s` is below `2 N`.
pub const MAX_OVERSTATED_MARGIN: f64 = 0.045;

/// The largest errors of the triangle's shape that is read from the tables of a pair of couplers.
///
/// A table has sixteen intervals per octave. Over an interval of length `h`, a straight line differs from a function
/// `f` by at most `h^2 / 8` times the largest second derivative of `f`. As `h` is at most a sixteenth of the argument
/// `t`, the difference is at most `|t^2 f''| / 2048`. For a product of powers of straight lines, where `power` is an
/// exponent, `p + q t` a line and `l = q t / (p + q t)`,
///
/// ```text
/// t^2 f'' = f ((sum of power l)^2 - sum of power l^2)
/// ```
///
/// `Product::max_bend_and_value` computes a bound of `|t^2 f''|`, the bend, over an interval, from the ends of the
/// range of each `l`. Below its peak the function of the table over `s` is constant, so it has no bend. The following
/// roundings add to the error: the rounding of the entries and of the value read, together 1 unit of Q10 (1.5 for the
/// skew, whose entries are rounded to nearest and whose value is rounded down); the rounding of the position within an
/// interval to 16 bits; and the rounding of `R` and `N` down to whole units, by at most 1/4.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShapeError {
    /// The largest error of the rise, dimensionless.
    pub rise: f64,
    /// The largest error of the skew, dimensionless.
    pub skew: f64,
}

impl ShapeError {
    /// Computes the errors for couplers in whole steps, over a range of the squared distance between the crank tips,
    /// U^2.
    pub fn compute(left: i16, right: i16, [min_tips_sq, max_tips_sq]: [f64; 2]) -> Self {
        let (a, b) = (f64::from(left) / 2.0, f64::from(right) / 2.0);
        // R and N of the derivation.
        let reach_sq = (a + b).powi(2).floor();
        let folded_sq = (a - b).powi(2).floor();
        let root = |p: f64, q: f64| Factor { power: 0.5, p, q };
        let inverse = |p: f64, q: f64| Factor { power: -1.0, p, q };
        // A table begins with the octave that contains 1/1024 of the largest argument, so at 1/2048 of that argument or
        // above.
        let argument_ratio = 2048.0;
        let mut rise_error = 0.0f64;
        // `argument_range` is the range of the table's argument for the given distances, `table_range` the range in
        // which the table is read, and `first_argument` the argument at which the function begins.
        let mut include_reading_error =
            |product: Product,
             argument_range: [f64; 2],
             table_range: [f64; 2],
             first_argument: f64| {
                let argument_range = [
                    argument_range[0].max(table_range[0]),
                    argument_range[1].min(table_range[1]),
                ];
                if argument_range[0] <= argument_range[1] {
                    let [max_bend, max_value] =
                        product.max_bend_and_value(argument_range, first_argument);
                    let error = max_bend / 2048.0 + max_value / 65536.0 + Q10_UNIT;
                    // The relative error from rounding R and N down, taken as twice its first-order term, which depends
                    // on the distances of `s` from R and N.
                    let distances = [
                        (reach_sq - max_tips_sq).max(reach_sq / 4.0 / argument_ratio),
                        (min_tips_sq - folded_sq)
                            .max(folded_sq / argument_ratio)
                            .max(1.0),
                    ];
                    let relative_rounding = 0.25 / distances[0] + 0.25 / distances[1];
                    rise_error = rise_error.max(error + max_value * relative_rounding);
                }
            };
        let peak_sq = 2.0 * reach_sq * folded_sq / (reach_sq + folded_sq);
        include_reading_error(
            Product([
                root(reach_sq, -1.0),
                root(-folded_sq, 1.0),
                inverse(0.0, 1.0),
            ]),
            [min_tips_sq, max_tips_sq],
            [
                (2.0 * folded_sq).max(reach_sq / argument_ratio),
                0.75 * reach_sq,
            ],
            peak_sq,
        );
        include_reading_error(
            Product([
                root(0.0, 1.0),
                root(reach_sq - folded_sq, -1.0),
                inverse(reach_sq, -1.0),
            ]),
            [reach_sq - max_tips_sq, reach_sq - min_tips_sq],
            [reach_sq / 4.0 / argument_ratio, reach_sq / 4.0],
            0.0,
        );
        include_reading_error(
            Product([
                root(0.0, 1.0),
                root(reach_sq - folded_sq, -1.0),
                inverse(folded_sq, 1.0),
            ]),
            [min_tips_sq - folded_sq, max_tips_sq - folded_sq],
            [folded_sq / argument_ratio, folded_sq],
            0.0,
        );
        let min_argument = min_tips_sq.max(reach_sq / argument_ratio);
        let skew = (reach_sq * folded_sq).sqrt() / min_argument;
        // For f = 1 / t, |t^2 f''| is 2 f; an interval begins at most a sixteenth below the argument.
        let reading_error = 2.0 * skew * (17.0 / 16.0) / 2048.0 + skew / 65536.0;
        let skew_error = if left == right {
            0.0
        } else {
            reading_error + 1.5 * Q10_UNIT + 1.0 / min_argument
        };
        Self {
            rise: rise_error,
            skew: skew_error,
        }
    }
}

/// The factor `(p + q t)^power` of a function.
#[derive(Clone, Copy)]
struct Factor {
    power: f64,
    p: f64,
    q: f64,
}

/// A function of `t` that is the product of three factors.
struct Product([Factor; 3]);

impl Product {
    /// Computes upper bounds of `|t^2 f''|` and of the value over a range of `t`. The range is extended by an interval
    /// at either end, but not below `first_argument`.
    fn max_bend_and_value(&self, [low, high]: [f64; 2], first_argument: f64) -> [f64; 2] {
        let t_ends = [(low * 16.0 / 17.0).max(first_argument), high * 17.0 / 16.0];
        let (mut sum_range, mut square_sum_range, mut max_value) = ([0.0; 2], [0.0; 2], 1.0f64);
        for Factor { power, p, q } in self.0 {
            // At an end of the range, rounding might make the line zero or negative.
            let line_ends = t_ends.map(|t| (p + q * t).max(1e-9));
            let mut l_range = [q * t_ends[0] / line_ends[0], q * t_ends[1] / line_ends[1]];
            l_range.sort_by(f64::total_cmp);
            let mut l_sq_range = l_range.map(|l| l * l);
            l_sq_range.sort_by(f64::total_cmp);
            let multiply_by_power = |range: [f64; 2]| {
                let mut products = range.map(|end| power * end);
                products.sort_by(f64::total_cmp);
                products
            };
            for (total_range, term_range) in [
                (&mut sum_range, multiply_by_power(l_range)),
                (&mut square_sum_range, multiply_by_power(l_sq_range)),
            ] {
                *total_range = [
                    total_range[0] + term_range[0],
                    total_range[1] + term_range[1],
                ];
            }
            max_value *= line_ends[0].powf(power).max(line_ends[1].powf(power));
        }
        let max_sq = sum_range[0].abs().max(sum_range[1].abs()).powi(2);
        let min_sq = if sum_range[0] <= 0.0 && sum_range[1] >= 0.0 {
            0.0
        } else {
            sum_range[0].abs().min(sum_range[1].abs()).powi(2)
        };
        let bend = (max_sq - square_sum_range[0])
            .abs()
            .max((min_sq - square_sum_range[1]).abs());
        [bend * max_value, max_value]
    }
}

/// The largest errors of a five-bar's margins, at one pair of crank angles or over a range of pairs.
#[derive(Clone, Copy, Debug)]
pub struct MarginErrors {
    /// The error of the type-2 margin's magnitude, a sine.
    pub type2: f64,
    /// The error of the left crank's type-1 margin, a sine.
    pub type1_left: f64,
    /// The error of the right crank's type-1 margin, a sine.
    pub type1_right: f64,
    /// The error of the component of `k` along the base, mm.
    pub gap_x: f64,
    /// The smallest true type-2 margin in the range, a sine; 0 if the loop does not close in all of the range.
    pub min_type2: f64,
    /// True if the tables have a correct value in all of the range. Otherwise the computed margins may be too small by
    /// more than these errors, and a type-2 margin of at most [`MAX_OVERSTATED_MARGIN`] may be too large.
    pub do_bounds_hold: bool,
}

impl MarginErrors {
    /// Computes the errors from the exact lengths of a five-bar, mm, the same lengths in steps, and the crank angles in
    /// its own frame, deg. If the loop does not close, `type2` is the largest margin that the integer arithmetic may
    /// return.
    pub fn at_angles(
        five_bar: &kinematics::FiveBar,
        rounded_lengths: &FiveBarLengths,
        angles: [f64; 2],
    ) -> Self {
        let [left, right] = angles.map(Vector::from_angle);
        let tip = |crank: f64, direction: Vector| [crank * direction.x, crank * direction.y];
        let left_tip = tip(five_bar.left_crank_length, left);
        let right_tip = tip(five_bar.right_crank_length, right);
        let distance_mm =
            (five_bar.base + right_tip[0] - left_tip[0]).hypot(right_tip[1] - left_tip[1]);
        let direction_sums = [left.x.abs() + right.x.abs(), left.y.abs() + right.y.abs()];
        Self::compute(five_bar, rounded_lengths, direction_sums, [distance_mm; 2])
    }

    /// Computes the largest errors over all crank angles at which the distance between the crank tips is `near` to
    /// `far`, mm.
    pub fn over_range(
        five_bar: &kinematics::FiveBar,
        rounded_lengths: &FiveBarLengths,
        [near, far]: [f64; 2],
    ) -> Self {
        Self::compute(five_bar, rounded_lengths, [2.0; 2], [near, far])
    }

    /// Computes the errors from the sums of `|cos|` and `|sin|` of the two crank directions, and from the range of the
    /// distance between the crank tips. Single letters have their meaning in the module's derivation.
    fn compute(
        five_bar: &kinematics::FiveBar,
        rounded_lengths: &FiveBarLengths,
        [cosine_sum, sine_sum]: [f64; 2],
        range_mm: [f64; 2],
    ) -> Self {
        let u_per_mm = steps_per_mm(rounded_lengths.scale) / 2.0;
        let crank_sum = u_per_mm * (five_bar.left_crank_length + five_bar.right_crank_length) + 0.5;
        let e_x = 1.25 + cosine_sum / 4.0 + MAX_DIRECTION_ERROR * crank_sum;
        let e_y = 0.5 + sine_sum / 4.0 + MAX_DIRECTION_ERROR * crank_sum;
        let e = e_x.hypot(e_y);
        let [near, far] = range_mm.map(|mm| u_per_mm * mm);
        let [a, b] =
            [five_bar.left_coupler_length, five_bar.right_coupler_length].map(|mm| u_per_mm * mm);
        let z = e * (2.0 * far + e);
        let tips_sq_range = [(near - e).max(0.0).powi(2), (far + e).powi(2)];

        let cosine_at = |k: f64| (a * a + b * b - k * k) / (2.0 * a * b);
        let (near_cosine, far_cosine) = (cosine_at(near), cosine_at(far));
        let c = near_cosine.abs().max(far_cosine.abs());
        let min_denominator = 2.0 * (a - 0.25) * (b - 0.25);
        let c_error = (far + 0.25 + z) / min_denominator;
        let can_close = c <= 1.0;
        let sine_sq = |c: f64| (1.0 - c * c).max(0.0);
        let contains_right_angle = near_cosine > 0.0 && far_cosine < 0.0;
        let max_sine_sq = if contains_right_angle {
            1.0
        } else {
            sine_sq(near_cosine.abs().min(far_cosine.abs()))
        };
        let m_sq = sine_sq(c);
        let m = m_sq.sqrt();
        let q = if can_close {
            c_error * (2.0 * c + c_error)
        } else {
            2.0 * c_error
        };
        let root = |square: f64| square.max(0.0).sqrt().min(1.0);
        let low_root = root(m_sq - q);
        let sine_error = (m - low_root).max(root(m_sq + q) - m);
        let high_root = root(max_sine_sq + q);

        let [left, right] = rounded_lengths.couplers;
        let shape_error = ShapeError::compute(left, right, tips_sq_range);
        let [left, right] = [left, right].map(f64::from);
        let mean_coupler = (left + right) / 2.0;
        let square_unit = 2f64.powi((mean_coupler * mean_coupler).log2().floor() as i32 - 14);
        let max_rise = 2.0 * left / 2.0 * right / 2.0 * high_root / tips_sq_range[0].max(1.0)
            + shape_error.rise;
        let product_error = (shape_error.rise * tips_sq_range[1] + max_rise * square_unit / 2.0)
            / (left * right / 2.0);
        let coupler_product = left * right / square_unit;
        let reciprocal_error =
            (1.0 / (coupler_product - 1.0) + Q15_UNIT) * (high_root + product_error);
        let type2_error = sine_error + product_error + 2.0 * Q15_UNIT + reciprocal_error + Q15_UNIT;

        let line_turn = (e / near.max(e)).asin();
        let type1_error = |coupler: f64| {
            let a = coupler / 2.0;
            let tip_turn = (0.5 + e) / ((a - 0.25) * low_root.max(1e-9)) + line_turn;
            let (min_k, max_k) = (tips_sq_range[0].sqrt().max(1.0), far + e);
            let component_error = 0.5 + 2f64.sqrt() * MAX_DIRECTION_ERROR * max_k;
            let scaled_sine_error = component_error
                * (2f64.sqrt() * 2.0 * a / min_k + shape_error.rise + shape_error.skew)
                + max_k * shape_error.rise.hypot(shape_error.skew)
                + 2.0;
            tip_turn + scaled_sine_error / (2.0 * a) + 1.01 * coupler / 2f64.powi(27) + Q15_UNIT
        };
        Self {
            type2: type2_error,
            type1_left: type1_error(left),
            type1_right: type1_error(right),
            gap_x: e_x / u_per_mm,
            min_type2: m,
            do_bounds_hold: can_close && low_root >= MIN_BOUNDED_MARGIN,
        }
    }

    /// The larger error of the two type-1 margins, a sine.
    pub fn type1(&self) -> f64 {
        self.type1_left.max(self.type1_right)
    }
}

/// Computes the largest error of a slider's length, mm. In each coordinate, four roundings change the length by at most
/// half a step each: the rounding of the offset or the base, of each of the two arms, and of the sum of the products.
/// The sines and cosines of the arms' directions have an error of at most [`MAX_DIRECTION_ERROR`].
pub fn slider_error(slider: &kinematics::Slider, rounded_slider: &Slider) -> f64 {
    let steps_per_mm = steps_per_mm(rounded_slider.scale);
    let arm_sum =
        (slider.front_arm * steps_per_mm).round() + (slider.rear_arm * steps_per_mm).round();
    2f64.sqrt() * (0.5 + 0.5 + 0.5 + 0.5 + MAX_DIRECTION_ERROR * arm_sum) / steps_per_mm
}

/// Returns the number of steps of a scale in a millimetre.
pub(crate) fn steps_per_mm(scale: Scale) -> f64 {
    f64::from(1u32 << scale.bits)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sample::Sample;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        // Tests in `guard::clearance` and `guard::five_bar` check the bound at a single pair of angles.
        #[test]
        fn a_bound_over_a_range_holds_at_every_pair_of_angles_in_the_range(
            (robot, pose) in Sample::random_with_pose(),
            fraction_below in 0.0..1.0f64,
            fraction_above in 0.0..1.0f64,
            // The decimal logarithm of the range's width in mm. The largest width exceeds the change of the crank tips'
            // distance within a certified cell.
            log_width in -4.0..0.7f64,
        ) {
            let [a1, a2, ..] = robot.degrees(&pose);
            let five_bar = robot.measurements.lizard.end(kinematics::End::Head);
            let Ok(exact_pose) = five_bar.forward(a1, a2) else {
                return Ok(());
            };
            let (distance_mm, width_mm) = (exact_pose.gap.length(), 10f64.powf(log_width));
            let range = [(distance_mm - fraction_below * width_mm).max(0.0), distance_mm + fraction_above * width_mm];
            let errors_at_angles = MarginErrors::at_angles(&five_bar, &robot.content.ends[0], [a1, a2]);
            let errors_over_range = MarginErrors::over_range(&five_bar, &robot.content.ends[0], range);
            prop_assert!(errors_over_range.min_type2 <= exact_pose.type2 + 1e-12);
            if !errors_over_range.do_bounds_hold {
                return Ok(());
            }
            prop_assert!(errors_at_angles.do_bounds_hold);
            for (name, error, bound) in [
                ("type-2", errors_at_angles.type2, errors_over_range.type2),
                ("type-1 left", errors_at_angles.type1_left, errors_over_range.type1_left),
                ("type-1 right", errors_at_angles.type1_right, errors_over_range.type1_right),
                ("gap", errors_at_angles.gap_x, errors_over_range.gap_x),
            ] {
                prop_assert!(error <= bound + 1e-12, "{name}: {error}, at most {bound} allowed");
            }
        }
    }
}
