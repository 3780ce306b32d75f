//! The chi-square distribution.

/// The value that a chi-square variable exceeds with a probability of 1 %, by the approximation of Wilson and
/// Hilferty (1931): accurate to 2 % from one degree of freedom on.
pub(crate) fn percentile_99(freedom: f64) -> f64 {
    /// The normal deviate that is exceeded with a probability of 1 %.
    const DEVIATE: f64 = 2.326_35;
    let spread = 2.0 / (9.0 * freedom);
    freedom * (1.0 - spread + DEVIATE * spread.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_that_of_tables() {
        for (freedom, table_value) in [(1.0, 6.635), (2.0, 9.210), (5.0, 15.086), (15.0, 30.578)] {
            let computed_value = percentile_99(freedom);
            assert!(
                (computed_value / table_value - 1.0).abs() < 0.02,
                "{freedom}: {computed_value}"
            );
        }
    }
}
