//! A measured value with its standard error.

/// A measured value with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The measured value.
    pub value: f64,
    /// Its standard error: the true value is within two errors with a probability of 95 %.
    pub error: f64,
}

impl Figure {
    /// True if `value` is more than two errors below this figure.
    pub fn is_above(&self, value: f64) -> bool {
        self.value - value > 2.0 * self.error
    }
}
