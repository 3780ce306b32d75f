//! The chi-square distribution.

/// Computes the value that a chi-square variable exceeds with a probability of 1 %. The approximation of Wilson and
/// Hilferty (1931) has an error below 2 % for one degree of freedom or more.
pub(crate) fn compute_percentile_99(degrees_of_freedom: f64) -> f64 {
    /// The value that a standard normal variable exceeds with a probability of 1 %.
    const NORMAL_DEVIATE: f64 = 2.326_35;
    let variance = 2.0 / (9.0 * degrees_of_freedom);
    degrees_of_freedom * (1.0 - variance + NORMAL_DEVIATE * variance.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentile_99_matches_the_table() {
        for (degrees_of_freedom, table_value) in
            [(1.0, 6.635), (2.0, 9.210), (5.0, 15.086), (15.0, 30.578)]
        {
            let computed_value = compute_percentile_99(degrees_of_freedom);
            assert!(
                (computed_value / table_value - 1.0).abs() < 0.02,
                "{degrees_of_freedom} degrees of freedom: expected {table_value}, got {computed_value}"
            );
        }
    }
}
