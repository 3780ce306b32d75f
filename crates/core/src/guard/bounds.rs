//! The largest difference between integer and floating-point results: proved, not measured.
//!
//! Each bound here adds up all roundings of one number, in the order in which they happen, each at its worst.
//! Nothing in it is measured except the sines of [`crate::guard::trig`], which a test of that module compares at
//! every angle. A test that finds an error beyond its bound has found a mistake in the code or in this derivation;
//! chance is no explanation.
//!
//! Lengths of a five-bar (head or tail) are counted in `U`, two steps of its bars, like the distance of the crank
//! tips. `k` is the vector from the left crank tip to the right one, `s = k^2`, `a` and `b` are the couplers,
//! `R = (a + b)^2`, `N = (a - b)^2`. A prime, as in `k'`, marks the integer result for a true value.
//!
//! **1. Crank tips.** Base and cranks are rounded to a step, 1/4 U each. Half the base
//! loses 1/2 U, the rounded sum of the products 1/2 U, and a direction is off by
//! [`MAX_DIRECTION_ERROR`] in sine and cosine. So `k'` is within `e` of `k`:
//!
//! ```text
//! e_x = 1/4 + 1/2 + 1/2 + (|cos| + |cos|) / 4 + DIRECTION (c1 + c2)
//! e_y =             1/2 + (|sin| + |sin|) / 4 + DIRECTION (c1 + c2)
//! ```
//!
//! **2. The triangle.** `c = cos(gamma) = (a^2 + b^2 - s) / 2ab` between the couplers.
//! With couplers that are off by `x` and `y`, at most 1/4 U each, and `s` by `z`,
//!
//! ```text
//! c' - c = (2x (a - b c) + 2y (b - a c) + x^2 + y^2 - 2xyc - z) / 2a'b'
//! ```
//!
//! where `a - b c` is the component of `k` along the coupler, so at most `|k|`. As `sin^2 = 1 - cos^2`, a sine
//! of `m` becomes one between the roots of `m^2 - q` and of `m^2 + q`, with `q = |c' - c| (2 |c| + |c' - c|)`.
//!
//! The angle at a crank tip changes by at most `(|x| + |y| + e) / (a sin(gamma))`: that is the derivative of
//! the triangle's angle by its sides, taken along a straight path from one triangle to the other, and on all of
//! it the sine is at least the lower root. The line `k` itself turns by at most `asin(e / |k|)`.
//!
//! **3. The tables**, see [`LeanError`].
//!
//! **4. The products** of [`crate::guard::five_bar`]: the rounded square is off by half of its step, each shift
//! loses at most one unit of its result, and each reciprocal less than one unit of its own.
//!
//! **5. A range.** For many pairs of angles, only the distance of the crank tips is known, `k` in
//! `[near, far]`; sines and cosines in `e` are at most 1. Every term above then counts at its worst: `z`, `|k|`
//! and terms that grow with the distance at `far`; terms with the distance in the denominator at `near`. `c`
//! falls as `k` grows, so the largest `|c|`, and with it the smallest sine, for which both roots are the
//! farthest from it, is at an end of the range. So is the largest sine, unless `c` changes its sign in between.
//! A single pair of angles is a range without width.

use lizard_kinematics as kinematics;
use lizard_kinematics::Vector;

use crate::numbers::slider::Slider;
use crate::numbers::units::Scale;

/// The error of a sine or a cosine; see the test of [`crate::guard::trig`].
pub const MAX_DIRECTION_ERROR: f64 = 4.5e-5;

/// The step of a margin.
pub const Q15: f64 = 1.0 / 32768.0;

/// The step of a value read from a table.
const Q10: f64 = 1.0 / 1024.0;

/// The type-2 margin below which the tables may have no value. Where the rise is read over `R - s`, that is at
/// `R - s = R / 4096`, where the sine is `sqrt((R - s)(s - N)) / 2ab <= sqrt(R / 4096 . 4ab) / 2ab`, at most
/// .05 with couplers of a ratio of 8, the largest that their steps allow; over `s - N` at `N / 1024`, where it
/// is at most .077; over `s` at `R / 1024`, where it is at most .063, because that table is read there only if
/// `N < R / 2048`. Nor is the rise above 32, the largest that an entry holds: a step that begins there ends at
/// `17/16 R / 1024`, where the sine is at most .065. The value read in that step is too small. For couplers
/// that differ by little, the table over `s` holds its largest rise below the peak, and that is too large
/// there; the sine that it gives is at most .045, since the peak is below `2 N`.
///
/// The true margin is then below a tenth: by part 2 of the derivation it is at most the root of `m'^2 + q`, and
/// with the shortest couplers, of 2048 U, and `e` at most 3.1, `q` is at most `7.3 k / ab`: .0071 for stretched
/// couplers of equal length, where `m'` is .031, and .0031 for folded ones of a ratio of 8, where it is .077.
pub const MIN_KNOWN_MARGIN: f64 = 0.08;

/// The error of the tables of a pair of couplers.
///
/// A curve has sixteen steps to an octave. A straight line over a step `d` of a function
/// `f` is off by at most `d^2 / 8` times its largest second derivative, and `d` is at
/// most a sixteenth of the argument `t`, so by `|t^2 f''| / 2048`. For a product of
/// powers `e` of straight lines `p + q t`, with `l = q t / (p + q t)`,
///
/// ```text
/// t^2 f'' = f ((sum of e l)^2 - sum of e l^2)
/// ```
///
/// which `Product::max_bend_and_value` bounds over the step by the ends of each `l`. The function is constant below
/// its peak, where it has no bend at all. The roundings add to that: those of the entries and of the values read, 1
/// together (1.5 for the skew, whose entries are rounded to nearest and whose value down); a share of the step of 16
/// bits; and the quarter that `R` and `N` lose when they are rounded down to whole steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct LeanError {
    /// The largest error of the rise, which has no unit.
    pub rise: f64,
    /// The largest error of the skew, which has no unit.
    pub skew: f64,
}

impl LeanError {
    /// The error for couplers in whole steps, over a range of the squared distance of the crank tips, U^2.
    pub fn of(left: i16, right: i16, [low, high]: [f64; 2]) -> Self {
        let (a, b) = (f64::from(left) / 2.0, f64::from(right) / 2.0);
        let reach = (a + b).powi(2).floor();
        let min = (a - b).powi(2).floor();
        let root_of = |p: f64, q: f64| Factor { power: 0.5, p, q };
        let inverse_of = |p: f64, q: f64| Factor { power: -1.0, p, q };
        // A table starts with the octave that contains a 1024th of the largest argument.
        let octaves = 2048.0;
        let mut rise = 0.0f64;
        // `argument_range` is a range of the table's argument, `table_range` the part in which the table is read,
        // `first_argument` the argument at which its function begins.
        let mut add_reading_error = |product: Product,
                                     argument_range: [f64; 2],
                                     table_range: [f64; 2],
                                     first_argument: f64| {
            let argument_range = [
                argument_range[0].max(table_range[0]),
                argument_range[1].min(table_range[1]),
            ];
            if argument_range[0] <= argument_range[1] {
                let [bend, max_value] = product.max_bend_and_value(argument_range, first_argument);
                let error = bend / 2048.0 + max_value / 65536.0 + Q10;
                // From rounding R and N down: a relative error, taken as twice its first-order term.
                let end_distances = [
                    (reach - high).max(reach / 4.0 / octaves),
                    (low - min).max(min / octaves).max(1.0),
                ];
                let relative_rounding = 0.25 / end_distances[0] + 0.25 / end_distances[1];
                rise = rise.max(error + max_value * relative_rounding);
            }
        };
        let peak = 2.0 * reach * min / (reach + min);
        add_reading_error(
            Product([
                root_of(reach, -1.0),
                root_of(-min, 1.0),
                inverse_of(0.0, 1.0),
            ]),
            [low, high],
            [(2.0 * min).max(reach / octaves), 0.75 * reach],
            peak,
        );
        add_reading_error(
            Product([
                root_of(0.0, 1.0),
                root_of(reach - min, -1.0),
                inverse_of(reach, -1.0),
            ]),
            [reach - high, reach - low],
            [reach / 4.0 / octaves, reach / 4.0],
            0.0,
        );
        add_reading_error(
            Product([
                root_of(0.0, 1.0),
                root_of(reach - min, -1.0),
                inverse_of(min, 1.0),
            ]),
            [low - min, high - min],
            [min / octaves, min],
            0.0,
        );
        let low = low.max(reach / octaves);
        let skew = (reach * min).sqrt() / low;
        // The bend of 1 / s is 2; a step begins at most a sixteenth below.
        let bend = 2.0 * skew * (17.0 / 16.0) / 2048.0 + skew / 65536.0;
        let skew = if left == right {
            0.0
        } else {
            bend + 1.5 * Q10 + 1.0 / low
        };
        Self { rise, skew }
    }
}

/// `(p + q t)^power`.
#[derive(Clone, Copy)]
struct Factor {
    power: f64,
    p: f64,
    q: f64,
}

struct Product([Factor; 3]);

impl Product {
    /// The largest `|t^2 f''|` and the largest value, over a range of `t` that is extended by a
    /// step on either side, but not below `first_argument`.
    fn max_bend_and_value(&self, [low, high]: [f64; 2], first_argument: f64) -> [f64; 2] {
        let ends = [(low * 16.0 / 17.0).max(first_argument), high * 17.0 / 16.0];
        let (mut sum, mut squares, mut max_value) = ([0.0; 2], [0.0; 2], 1.0f64);
        for Factor { power, p, q } in self.0 {
            // Keeps rounding from making the line 0 or negative at a limit of the range.
            let line = ends.map(|t| (p + q * t).max(1e-9));
            let mut l = [q * ends[0] / line[0], q * ends[1] / line[1]];
            l.sort_by(f64::total_cmp);
            let mut square = l.map(|l| l * l);
            square.sort_by(f64::total_cmp);
            let scale_by_power = |range: [f64; 2]| {
                let mut products = range.map(|end| power * end);
                products.sort_by(f64::total_cmp);
                products
            };
            for (sum, terms) in [
                (&mut sum, scale_by_power(l)),
                (&mut squares, scale_by_power(square)),
            ] {
                *sum = [sum[0] + terms[0], sum[1] + terms[1]];
            }
            max_value *= line[0].powf(power).max(line[1].powf(power));
        }
        let max_sq = sum[0].abs().max(sum[1].abs()).powi(2);
        let min_sq = if sum[0] <= 0.0 && sum[1] >= 0.0 {
            0.0
        } else {
            sum[0].abs().min(sum[1].abs()).powi(2)
        };
        let bend = (max_sq - squares[0]).abs().max((min_sq - squares[1]).abs());
        [bend * max_value, max_value]
    }
}

/// The rounded numbers of a five-bar, on which its errors depend besides its true bars.
#[derive(Clone, Copy, Debug)]
pub struct RoundedBars {
    /// The scale of the five-bar's lengths.
    pub scale: Scale,
    /// The left and the right coupler in whole steps.
    pub couplers: [i16; 2],
}

/// The largest errors of the margins of a five-bar (head or tail), at one pair of crank angles or over a range of
/// them.
#[derive(Clone, Copy, Debug)]
pub struct EndErrors {
    /// The error of the type-2 margin's magnitude, a sine.
    pub type2: f64,
    /// The error of the left crank's type-1 margin, a sine.
    pub type1_left: f64,
    /// The error of the right crank's type-1 margin, a sine.
    pub type1_right: f64,
    /// The error of the crank tips' distance along the base, mm.
    pub along: f64,
    /// The smallest true type-2 margin in the range, a sine; 0 if the loop does not close everywhere in the range.
    pub min_type2: f64,
    /// True if the tables have a value at every true type-2 margin of the range.
    pub is_known: bool,
}

impl EndErrors {
    /// The errors for true bars, the integers made of them, and crank angles in the five-bar's own frame, deg. If
    /// the loop does not close, `type2` is the largest margin that the integers may compute.
    pub fn of(
        bars: &kinematics::FiveBar,
        integers: impl Into<RoundedBars>,
        angles: [f64; 2],
    ) -> Self {
        let [left, right] = angles.map(Vector::direction);
        let tip_of = |crank: f64, direction: Vector| [crank * direction.x, crank * direction.y];
        let (left_tip, right_tip) = (
            tip_of(bars.crank_left, left),
            tip_of(bars.crank_right, right),
        );
        let distance_mm =
            (bars.base + right_tip[0] - left_tip[0]).hypot(right_tip[1] - left_tip[1]);
        let direction_sums = [left.x.abs() + right.x.abs(), left.y.abs() + right.y.abs()];
        Self::at(bars, integers.into(), direction_sums, [distance_mm; 2])
    }

    /// The errors for all crank angles at which the distance of the crank tips is from `near` to `far`, mm.
    pub fn between(
        bars: &kinematics::FiveBar,
        integers: impl Into<RoundedBars>,
        [near, far]: [f64; 2],
    ) -> Self {
        Self::at(bars, integers.into(), [2.0; 2], [near, far])
    }

    /// The errors for given sums of the directions' `|cos|` and `|sin|`.
    fn at(
        bars: &kinematics::FiveBar,
        integers: RoundedBars,
        [cosines, sines]: [f64; 2],
        range_mm: [f64; 2],
    ) -> Self {
        let u_per_mm = per_mm(integers.scale) / 2.0;
        let cranks = u_per_mm * (bars.crank_left + bars.crank_right) + 0.5;
        let e_x = 1.25 + cosines / 4.0 + MAX_DIRECTION_ERROR * cranks;
        let e_y = 0.5 + sines / 4.0 + MAX_DIRECTION_ERROR * cranks;
        let e = e_x.hypot(e_y);
        let [near, far] = range_mm.map(|mm| u_per_mm * mm);
        let [a, b] = [bars.coupler_left, bars.coupler_right].map(|mm| u_per_mm * mm);
        let z = e * (2.0 * far + e);
        let tips_sq_range = [(near - e).max(0.0).powi(2), (far + e).powi(2)];

        let cosine_at = |k: f64| (a * a + b * b - k * k) / (2.0 * a * b);
        let (near_cosine, far_cosine) = (cosine_at(near), cosine_at(far));
        let c = near_cosine.abs().max(far_cosine.abs());
        let min_area = 2.0 * (a - 0.25) * (b - 0.25);
        let c_error = (far + 0.25 + z) / min_area;
        let can_close = c <= 1.0;
        let sine_sq_of = |c: f64| (1.0 - c * c).max(0.0);
        let contains_right_angle = near_cosine > 0.0 && far_cosine < 0.0;
        let max_sine_sq = if contains_right_angle {
            1.0
        } else {
            sine_sq_of(near_cosine.abs().min(far_cosine.abs()))
        };
        let m_sq = sine_sq_of(c);
        let m = m_sq.sqrt();
        let q = if can_close {
            c_error * (2.0 * c + c_error)
        } else {
            2.0 * c_error
        };
        let root_of = |square: f64| square.max(0.0).sqrt().min(1.0);
        let low_root = root_of(m_sq - q);
        let sine_error = (m - low_root).max(root_of(m_sq + q) - m);
        let high_root = root_of(max_sine_sq + q);

        let [left, right] = integers.couplers;
        let lean = LeanError::of(left, right, tips_sq_range);
        let [left, right] = [left, right].map(f64::from);
        let mean_coupler = (left + right) / 2.0;
        let square = 2f64.powi((mean_coupler * mean_coupler).log2().floor() as i32 - 14);
        let rise =
            2.0 * left / 2.0 * right / 2.0 * high_root / tips_sq_range[0].max(1.0) + lean.rise;
        let product = (lean.rise * tips_sq_range[1] + rise * square / 2.0) / (left * right / 2.0);
        let area = left * right / square;
        let area_error = (1.0 / (area - 1.0) + Q15) * (high_root + product);
        let type2 = sine_error + product + 2.0 * Q15 + area_error + Q15;

        let line_turn = (e / near.max(e)).asin();
        let type1_of = |coupler: f64| {
            let a = coupler / 2.0;
            let tip_turn = (0.5 + e) / ((a - 0.25) * low_root.max(1e-9)) + line_turn;
            let (near, far) = (tips_sq_range[0].sqrt().max(1.0), far + e);
            let component_error = 0.5 + 2f64.sqrt() * MAX_DIRECTION_ERROR * far;
            let opening_error = component_error
                * (2f64.sqrt() * 2.0 * a / near + lean.rise + lean.skew)
                + far * lean.rise.hypot(lean.skew)
                + 2.0;
            tip_turn + opening_error / (2.0 * a) + 1.01 * coupler / 2f64.powi(27) + Q15
        };
        Self {
            type2,
            type1_left: type1_of(left),
            type1_right: type1_of(right),
            along: e_x / u_per_mm,
            min_type2: m,
            is_known: can_close && low_root >= MIN_KNOWN_MARGIN,
        }
    }

    /// The larger error of the two type-1 margins, a sine.
    pub fn type1(&self) -> f64 {
        self.type1_left.max(self.type1_right)
    }
}

/// The error of a slider's length, mm. In each coordinate the offset or the base and both arms are rounded to a
/// step, half a step each, the sum of the products too, and the arms' directions are off by [`MAX_DIRECTION_ERROR`].
pub fn slider_error(side: &kinematics::Slider, integers: &Slider) -> f64 {
    let per_mm = per_mm(integers.scale);
    let arms = (side.front * per_mm).round() + (side.rear * per_mm).round();
    2f64.sqrt() * (0.5 + 0.5 + 0.5 + 0.5 + MAX_DIRECTION_ERROR * arms) / per_mm
}

/// Steps of a scale in a millimetre.
fn per_mm(scale: Scale) -> f64 {
    f64::from(1u32 << scale.bits)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sample::Sample;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        /// Tests in [`crate::guard::clearance`] and [`crate::guard::five_bar`] check the bound of a single
        /// pair of angles.
        #[test]
        fn a_bound_over_a_range_holds_at_every_pair_of_angles_in_it(
            (robot, pose) in Sample::random().prop_flat_map(|robot| {
                let pose = robot.pose();
                (Just(robot), pose)
            }),
            share_below in 0.0..1.0f64,
            share_above in 0.0..1.0f64,
            // Decimal logarithm of the range's width in mm: from nearly nothing to more than the crank tips
            // move within a cell.
            log_width in -4.0..0.7f64,
        ) {
            let [a1, a2, ..] = robot.degrees(&pose);
            let bars = robot.measures.lizard.end(kinematics::End::Head);
            let Ok(exact_pose) = bars.forward(a1, a2) else {
                return Ok(());
            };
            let (distance_mm, width_mm) = (exact_pose.gap.length(), 10f64.powf(log_width));
            let range = [(distance_mm - share_below * width_mm).max(0.0), distance_mm + share_above * width_mm];
            let errors_at_angles = EndErrors::of(&bars, &robot.ends[0], [a1, a2]);
            let errors_over_range = EndErrors::between(&bars, &robot.ends[0], range);
            prop_assert!(errors_over_range.min_type2 <= exact_pose.type2 + 1e-12);
            if !errors_over_range.is_known {
                return Ok(());
            }
            prop_assert!(errors_at_angles.is_known);
            for (name, error, bound) in [
                ("type-2", errors_at_angles.type2, errors_over_range.type2),
                ("type-1 left", errors_at_angles.type1_left, errors_over_range.type1_left),
                ("type-1 right", errors_at_angles.type1_right, errors_over_range.type1_right),
                ("along", errors_at_angles.along, errors_over_range.along),
            ] {
                prop_assert!(error <= bound + 1e-12, "{name}: {error} of {bound}");
            }
        }
    }
}
