//! The distribution of a sum of squares.

/// The sum of squares of so many normal deviates that 1 % of such sums exceed (Wilson and Hilferty 1931: to 2 % from one
/// degree of freedom on).
pub(crate) fn rare(freedom: f64) -> f64 {
    /// The normal deviate that 1 % exceed.
    const DEVIATE: f64 = 2.326_35;
    let spread = 2.0 / (9.0 * freedom);
    freedom * (1.0 - spread + DEVIATE * spread.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_that_of_tables() {
        for (freedom, tabled) in [(1.0, 6.635), (2.0, 9.210), (5.0, 15.086), (15.0, 30.578)] {
            let found = rare(freedom);
            assert!((found / tabled - 1.0).abs() < 0.02, "{freedom}: {found}");
        }
    }
}
