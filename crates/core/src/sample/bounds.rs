//! The bounds of [`crate::guard::bounds`] for the bars of a sample.

pub use crate::guard::bounds::*;

use super::Loop;

impl From<&Loop> for Bars {
    fn from(bars: &Loop) -> Self {
        Self {
            scale: bars.scale,
            couplers: [bars.couplers.left, bars.couplers.right],
        }
    }
}
