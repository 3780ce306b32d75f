//! The bounds of [`crate::bounds`] for the bars of a sample.

pub use crate::bounds::*;

use super::Loop;

impl From<&Loop> for Bars {
    fn from(bars: &Loop) -> Self {
        Self {
            scale: bars.scale,
            couplers: [bars.couplers.left, bars.couplers.right],
        }
    }
}
