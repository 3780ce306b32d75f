//! A measured figure with its standard error.

/// A measured figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The figure.
    pub value: f64,
    /// Its standard error: the truth lies within two of it with a probability of 95 %.
    pub error: f64,
}

impl Figure {
    /// True if zero, or another value, lies more than two errors below this figure.
    pub fn is_above(&self, value: f64) -> bool {
        self.value - value > 2.0 * self.error
    }
}
