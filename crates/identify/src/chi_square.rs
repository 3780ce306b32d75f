//! The chi-square distribution.

/// The value that a chi-square variable exceeds with a probability of 1 %. The approximation is that of Wilson and
/// Hilferty (1931), with an error below 2 % for one degree of freedom or more.
pub(crate) fn percentile_99(degrees_of_freedom: f64) -> f64 {
    /// The normal deviate that is exceeded with a probability of 1 %.
    const NORMAL_DEVIATE: f64 = 2.326_35;
    let variance = 2.0 / (9.0 * degrees_of_freedom);
    degrees_of_freedom * (1.0 - variance + NORMAL_DEVIATE * variance.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentile_99_agrees_with_tables() {
        for (degrees_of_freedom, table_value) in
            [(1.0, 6.635), (2.0, 9.210), (5.0, 15.086), (15.0, 30.578)]
        {
            let computed_value = percentile_99(degrees_of_freedom);
            assert!(
                (computed_value / table_value - 1.0).abs() < 0.02,
                "{degrees_of_freedom}: {computed_value}"
            );
        }
    }
}
