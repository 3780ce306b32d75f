//! The bounds of [`crate::guard::bounds`] for the bars of a sample.

pub use crate::guard::bounds::*;

use super::SampleFiveBar;

impl From<&SampleFiveBar> for RoundedBars {
    fn from(bars: &SampleFiveBar) -> Self {
        Self {
            scale: bars.scale,
            couplers: [bars.couplers.left, bars.couplers.right],
        }
    }
}
