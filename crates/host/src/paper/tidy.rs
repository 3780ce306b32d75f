//! Numbers for the eye.

/// A value rounded to some decimals, as it will be printed, without the sign of
/// a zero: no "-0.000".
pub fn tidy(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    // Adding a positive zero turns a negative one positive.
    (value * scale).round() / scale + 0.0
}

#[cfg(test)]
mod tests {
    use super::tidy;

    #[test]
    fn what_rounds_to_zero_has_no_sign() {
        for value in [-0.0, 0.0, -0.00049, 0.00049] {
            assert_eq!(format!("{:+.3}", tidy(value, 3)), "+0.000");
        }
        assert_eq!(format!("{:.3}", tidy(-0.0005, 3)), "-0.001");
        assert_eq!(format!("{:.2}", tidy(-319.987, 2)), "-319.99");
    }
}
