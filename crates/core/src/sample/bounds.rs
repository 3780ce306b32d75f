//! The bounds of [`crate::guard::bounds`], applied to a sample's five-bars.

pub use crate::guard::bounds::*;

use super::SampleFiveBar;

impl From<&SampleFiveBar> for RoundedLengths {
    fn from(five_bar: &SampleFiveBar) -> Self {
        Self {
            scale: five_bar.scale,
            couplers: [five_bar.couplers.left, five_bar.couplers.right],
        }
    }
}
