//! Degrees, the one angle unit of the interface.

use core::f64::consts::PI;

/// Sine and cosine of an angle in degrees.
///
/// ```
/// let (sin, cos) = lizard_kinematics::sin_cos(30.0);
/// assert!((sin - 0.5).abs() < 1e-15 && (cos - 0.75f64.sqrt()).abs() < 1e-15);
/// ```
pub fn sin_cos(degrees: f64) -> (f64, f64) {
    libm::sincos(degrees * (PI / 180.0))
}

/// The same direction in (-180, 180] degrees.
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
    let turned = degrees - 360.0 * libm::floor(degrees / 360.0);
    if turned > 180.0 {
        turned - 360.0
    } else {
        turned
    }
}
