//! Trigonometry in degrees, the unit of all angles in the crate's interface.
//!
//! Reducing an angle by multiples of 90 degrees is exact, but reducing it by multiples of pi/2 is not. With degrees,
//! sin 180 is therefore exactly 0, and angles that differ by whole turns have the same sine, bit for bit. Only for odd
//! multiples of 45 degrees may the last bit differ, because either of the two neighbouring quadrants may be used. Sine,
//! cosine and arc tangent do not branch on ordinary arguments, so they are several times faster than the general
//! functions of a mathematics library. They use only IEEE additions, multiplications, divisions and comparisons, never
//! fused, and give the same bits on every host.
//!
//! The polynomials come from `src/angle/polynomials.rs`, which computes them with a precision of 256 bits. Their
//! approximation errors are at most 2.1e-17 of the result, a fifth of an f64's rounding error.

use core::f64::consts::PI;

/// Coefficients of (sin r - r) / r^3 in powers of r^2, for |r| up to 45 degrees.
const SIN: [f64; 6] = [
    -0.16666666666666666,
    0.008333333333330948,
    -0.00019841269836756774,
    2.7557316101617874e-6,
    -2.505113165023518e-8,
    1.5918115263265974e-10,
];

/// Coefficients of (cos r - 1 + r^2 / 2) / r^4 in powers of r^2, for |r| up to 45 degrees.
const COS: [f64; 6] = [
    0.041666666666666664,
    -0.0013888888888887398,
    2.480158729876456e-5,
    -2.7557317271145144e-7,
    2.087614614655861e-9,
    -1.1382623647474604e-11,
];

/// Coefficients of (atan u - u) / u^3 in powers of u^2, for |u| up to tan 22.5 degrees.
const ATAN: [f64; 11] = [
    -0.3333333333333333,
    0.19999999999995516,
    -0.14285714284665682,
    0.11111111015187018,
    -0.0909090457530649,
    0.07692183125376892,
    -0.06664510525508936,
    0.05858140904866328,
    -0.050854078345894844,
    0.03923044778479309,
    -0.019175404711104935,
];

/// tan 22.5 degrees.
const TAN_22_5_DEGREES: f64 = 0.41421356237309503;

/// 1.5 * 2^52. Adding this constant rounds a number to an integer, whose last bits are those of the
/// sum; subtracting the constant again gives the integer.
const ROUNDING_CONSTANT: f64 = 6_755_399_441_055_744.0;

/// Smallest magnitude of an angle, deg, that [`ROUNDING_CONSTANT`] may not reduce exactly.
const MIN_HUGE_ANGLE: f64 = 1e15;

/// Evaluates a polynomial by Horner's rule.
#[inline(always)]
fn evaluate_polynomial<const N: usize>(coefficients: &[f64; N], x: f64) -> f64 {
    let mut sum = coefficients[N - 1];
    let mut i = N - 1;
    while i > 0 {
        i -= 1;
        sum = sum * x + coefficients[i];
    }
    sum
}

/// Returns `if_ones` if the mask is all ones, `if_zero` if it is zero, without a branch: on random input, half of a
/// branch's predictions would be wrong.
#[inline(always)]
fn select(mask: u64, if_ones: f64, if_zero: f64) -> f64 {
    f64::from_bits(if_zero.to_bits() ^ ((if_ones.to_bits() ^ if_zero.to_bits()) & mask))
}

/// Returns a mask of all ones if the condition is true, otherwise zero.
#[inline(always)]
fn to_mask(condition: bool) -> u64 {
    u64::from(condition).wrapping_neg()
}

/// The sign bit of an f64.
const SIGN_BIT: u64 = 1 << 63;

/// Sine and cosine of an angle in degrees, each within 1.5 units in the last place of the exact value. NaN if the angle
/// is infinite.
///
/// ```
/// let (sin, cos) = lizard_kinematics::sin_cos(30.0);
/// assert!((sin - 0.5).abs() < 1e-15 && (cos - 0.75f64.sqrt()).abs() < 1e-15);
/// assert_eq!(lizard_kinematics::sin_cos(180.0), (0.0, -1.0));
/// ```
#[inline]
pub fn sin_cos(degrees: f64) -> (f64, f64) {
    let ([sin], [cos]) = sin_cos_all([degrees]);
    (sin, cos)
}

/// Sines and cosines of several angles in degrees, bit for bit those of [`sin_cos`]. The compiler can
/// vectorise the computation.
#[inline(always)]
pub fn sin_cos_all<const N: usize>(degrees: [f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    let mut degrees = degrees;
    let mut has_huge_angle = false;
    for angle in &degrees {
        has_huge_angle |= angle.abs() >= MIN_HUGE_ANGLE;
    }
    if has_huge_angle {
        reduce_huge_angles(&mut degrees);
    }
    for i in 0..N {
        let rounded = degrees[i] * (1.0 / 90.0) + ROUNDING_CONSTANT;
        let quadrant = rounded.to_bits();
        let r = (degrees[i] - (rounded - ROUNDING_CONSTANT) * 90.0) * (PI / 180.0);
        let z = r * r;
        let sin = r + r * (z * evaluate_polynomial(&SIN, z));
        // The difference 1 - z/2 is rounded; its rounding error is added together with the small terms.
        let half_square = 0.5 * z;
        let main_term = 1.0 - half_square;
        let cos = main_term
            + (((1.0 - main_term) - half_square) + z * (z * evaluate_polynomial(&COS, z)));
        // In the odd quadrants sine and cosine change places. The sine is negative in quadrants 2 and
        // 3, the cosine in 1 and 2. Adding 0.0 makes a negative zero positive.
        let odd_mask = (quadrant & 1).wrapping_neg();
        let sine_sign = (quadrant & 2) << 62;
        let cosine_sign = sine_sign ^ (odd_mask & SIGN_BIT);
        sines[i] = f64::from_bits(select(odd_mask, cos, sin).to_bits() ^ sine_sign) + 0.0;
        cosines[i] = f64::from_bits(select(odd_mask, sin, cos).to_bits() ^ cosine_sign) + 0.0;
    }
    (sines, cosines)
}

/// Reduces angles of any magnitude to less than a turn, exactly.
#[cold]
fn reduce_huge_angles(degrees: &mut [f64]) {
    for angle in degrees {
        *angle %= 360.0;
    }
}

/// The angle of a vector in (-180, 180] degrees, within 2 units in the last place; 0 for the zero vector.
///
/// ```
/// assert_eq!(lizard_kinematics::atan2(1.0, -1.0), 135.0);
/// assert_eq!(lizard_kinematics::atan2(-0.0, -1.0), 180.0);
/// ```
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    let (ax, ay) = (x.abs(), y.abs());
    let steep_mask = to_mask(ay > ax);
    let (long, short) = (select(steep_mask, ay, ax), select(steep_mask, ax, ay));
    // Within the first 45 degrees, the polynomial is evaluated relative to 0 or to 45 degrees, whichever is nearer.
    let diagonal_mask = to_mask(short > TAN_22_5_DEGREES * long);
    let numerator = select(diagonal_mask, short - long, short);
    let denominator = select(diagonal_mask, short + long, long);
    let zero_mask = to_mask(denominator == 0.0);
    let u = numerator / select(zero_mask, 1.0, denominator);
    let z = u * u;
    let base = select(diagonal_mask, 45.0, 0.0);
    let eighth = base + (u + u * (z * evaluate_polynomial(&ATAN, z))) * (180.0 / PI);
    let quarter = select(steep_mask, 90.0 - eighth, eighth);
    let half = select(to_mask(x < 0.0), 180.0 - quarter, quarter);
    select(to_mask(y < 0.0), -half, half)
}

/// Wraps an angle to (-180, 180] degrees, exactly. NaN if the angle is infinite.
///
/// ```
/// use lizard_kinematics::wrap;
/// assert_eq!(wrap(318.5), -41.5);
/// assert_eq!(wrap(-180.0), 180.0);
/// ```
pub fn wrap(degrees: f64) -> f64 {
    if degrees > -180.0 && degrees <= 180.0 {
        return degrees;
    }
    // The remainder is exact, whatever the size of the angle.
    let remainder = degrees % 360.0;
    if remainder > 180.0 {
        remainder - 360.0
    } else if remainder <= -180.0 {
        remainder + 360.0
    } else {
        remainder
    }
}

#[cfg(test)]
mod polynomials;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100_000))]

        #[test]
        fn sines_and_cosines_agree_with_libm(degrees in -45.0..45.0f64) {
            // Within 45 degrees the only error of libm's argument is the rounding of its conversion to radians.
            let (sin, cos) = sin_cos(degrees);
            let (expected_sin, expected_cos) = libm::sincos(degrees.to_radians());
            prop_assert!((sin - expected_sin).abs() <= 3.0 * f64::EPSILON * expected_sin.abs(), "{sin}, expected {expected_sin}");
            prop_assert!((cos - expected_cos).abs() <= 2.0 * f64::EPSILON * expected_cos, "{cos}, expected {expected_cos}");
        }

        #[test]
        fn quarter_turns_only_swap_sine_and_cosine_and_change_their_signs(
            degrees in -44.99..44.99f64, quarter_turns in -1_000_000..1_000_000i32,
        ) {
            // Adding quarter turns to a multiple of 1/4096 degree is exact.
            let rounded = (degrees * 4096.0).round() / 4096.0;
            // At 45 degrees, either of the two neighbouring quadrants may be used.
            prop_assume!(rounded.abs() < 45.0);
            let (sin, cos) = sin_cos(rounded);
            let expected_pairs = [(sin, cos), (cos, -sin), (-sin, -cos), (-cos, sin)];
            let expected = expected_pairs[quarter_turns.rem_euclid(4) as usize];
            let computed = sin_cos(rounded + 90.0 * f64::from(quarter_turns));
            prop_assert_eq!(computed, expected);
        }

        #[test]
        fn arc_tangents_agree_with_libm(
            x in -1.0..1.0f64, y in -1.0..1.0f64, exponent in -300..300i32,
        ) {
            let scale = 10f64.powi(exponent);
            let computed = atan2(y * scale, x * scale);
            let expected = libm::atan2(y * scale, x * scale).to_degrees();
            prop_assert!((computed - expected).abs() <= 3.0 * f64::EPSILON * expected.abs(), "{computed}, expected {expected}");
        }

        #[test]
        fn atan2_inverts_sin_cos(degrees in -180.0..180.0f64) {
            let (sin, cos) = sin_cos(degrees);
            prop_assert!((atan2(sin, cos) - degrees).abs() < 1e-13);
        }
    }

    #[test]
    fn the_axes_and_the_diagonals_are_exact() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert_eq!(sin_cos(90.0), (1.0, 0.0));
        assert_eq!(sin_cos(-90.0), (-1.0, 0.0));
        assert_eq!(sin_cos(360.0e12), (0.0, 1.0));
        for (y, x, degrees) in [
            (0.0, 1.0, 0.0),
            (1.0, 1.0, 45.0),
            (1.0, 0.0, 90.0),
            (1.0, -1.0, 135.0),
            (0.0, -1.0, 180.0),
            (-0.0, -1.0, 180.0),
            (-1.0, -1.0, -135.0),
            (-1.0, 0.0, -90.0),
            (0.0, 0.0, 0.0),
            (-0.0, -0.0, 0.0),
        ] {
            assert_eq!(atan2(y, x), degrees, "atan2({y}, {x})");
        }
    }

    #[test]
    fn nan_and_infinity_give_nan_but_huge_angles_do_not() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(sin_cos(value).0.is_nan() && sin_cos(value).1.is_nan());
        }
        assert!(atan2(f64::NAN, 1.0).is_nan() && atan2(1.0, f64::NAN).is_nan());
        let (sin, cos) = sin_cos(1e300);
        assert!((sin * sin + cos * cos - 1.0).abs() < 1e-15);
    }

    #[test]
    fn coefficients_are_accurate_and_match_the_generator() {
        let tables: [&[f64]; 3] = [&SIN, &COS, &ATAN];
        for (polynomial, coefficients) in polynomials::POLYNOMIALS.iter().zip(tables) {
            let name = polynomial.name;
            assert_eq!(polynomial.compute_coefficients(), coefficients, "{name}");
            let error = polynomial.compute_max_relative_error(coefficients);
            assert!(error < 2.1e-17, "{name}: the error is {error:e}");
        }
    }

    #[test]
    fn wrapping_is_exact_for_any_angle() {
        for (degrees, expected) in [
            (540.0, 180.0),
            (-540.0, 180.0),
            (-179.5, -179.5),
            (181.0, -179.0),
            (-181.0, 179.0),
            (36e20, 0.0),
            (1e308, 1e308 % 360.0),
            (-1e308, -1e308 % 360.0),
        ] {
            // Exactly one of these three angles, which are a turn apart, is in range.
            let candidates = [expected - 360.0, expected, expected + 360.0];
            let expected = candidates
                .into_iter()
                .find(|candidate| *candidate > -180.0 && *candidate <= 180.0);
            assert_eq!(Some(wrap(degrees)), expected, "{degrees}");
            assert_eq!(sin_cos(degrees), sin_cos(wrap(degrees)), "{degrees}");
        }
        assert!(wrap(f64::INFINITY).is_nan() && wrap(f64::NAN).is_nan());
    }
}
