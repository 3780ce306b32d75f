//! A measured value with its standard error.

/// A measured value with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The measured value.
    pub value: f64,
    /// Its standard error: the true value is within two standard errors with a probability of 95 %.
    pub error: f64,
}

impl Figure {
    /// True if this figure exceeds `value` by more than two standard errors.
    pub fn is_significantly_above(&self, value: f64) -> bool {
        self.value - value > 2.0 * self.error
    }
}
