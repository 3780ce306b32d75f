//! Trigonometry in degrees against the mathematics library.

use lizard_kinematics::{atan2, sin_cos};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 100_000, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn sines_and_cosines_are_the_librarys(degrees in -45.0..45.0f64) {
        // Within 45 degrees the library's argument has no error of its own
        // beyond one rounding.
        let (sin, cos) = sin_cos(degrees);
        let (s, c) = libm::sincos(degrees.to_radians());
        prop_assert!((sin - s).abs() <= 3.0 * f64::EPSILON * s.abs(), "{sin} {s}");
        prop_assert!((cos - c).abs() <= 2.0 * f64::EPSILON * c, "{cos} {c}");
    }

    #[test]
    fn quarter_turns_change_nothing_but_places_and_signs(
        degrees in -44.99..44.99f64, turns in -1_000_000..1_000_000i32,
    ) {
        // On a grid on which adding the turns is exact, and short of 45 degrees,
        // which belong to two quarters.
        let grid = (degrees * 4096.0).round() / 4096.0;
        // On a diagonal either octant may answer.
        prop_assume!(grid.abs() < 45.0);
        let (sin, cos) = sin_cos(grid);
        let quarter = [(sin, cos), (cos, -sin), (-sin, -cos), (-cos, sin)];
        let expected = quarter[turns.rem_euclid(4) as usize];
        let found = sin_cos(grid + 90.0 * f64::from(turns));
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn arc_tangents_are_the_librarys(
        x in -1.0..1.0f64, y in -1.0..1.0f64, size in -300..300i32,
    ) {
        let scale = 10f64.powi(size);
        let ours = atan2(y * scale, x * scale);
        let truth = libm::atan2(y * scale, x * scale).to_degrees();
        prop_assert!((ours - truth).abs() <= 3.0 * f64::EPSILON * truth.abs(), "{ours} {truth}");
    }

    #[test]
    fn the_angle_of_a_direction_is_the_angle(degrees in -180.0..180.0f64) {
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
        assert_eq!(atan2(y, x), degrees, "{y} {x}");
    }
}

#[test]
fn what_is_no_number_stays_none() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(sin_cos(bad).0.is_nan() && sin_cos(bad).1.is_nan());
    }
    assert!(atan2(f64::NAN, 1.0).is_nan() && atan2(1.0, f64::NAN).is_nan());
    let (sin, cos) = sin_cos(1e300);
    assert!((sin * sin + cos * cos - 1.0).abs() < 1e-15);
}
