//! The bounds of [`crate::guard::bounds`], applied to the five-bars of a section.

pub use crate::guard::bounds::*;

use crate::numbers::section::FiveBarLengths;

impl From<&FiveBarLengths> for RoundedLengths {
    fn from(lengths: &FiveBarLengths) -> Self {
        Self {
            scale: lengths.scale,
            couplers: lengths.couplers,
        }
    }
}
