//! A measured value with its standard error.

/// A measured value with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The measured value.
    pub value: f64,
    /// The standard error: the true value is within two standard errors of `value` with a probability of 95 %.
    pub standard_error: f64,
}

impl Estimate {
    /// Creates an estimate from its value and standard error.
    pub fn new(value: f64, standard_error: f64) -> Self {
        Self {
            value,
            standard_error,
        }
    }
}
