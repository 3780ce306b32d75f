//! The guard: the geometry that distinguishes safe poses from poses that could break a linkage.
//!
//! [`clearance`] measures a pose: the singularity margins of each [five-bar](five_bar) and of each leg, and the lengths
//! of the [sliders](slider). [`hazard`] describes the first limit that a pose violates.

#[cfg(any(test, feature = "host"))]
pub mod bounds;
mod check;
pub mod clearance;
pub mod five_bar;
pub mod hazard;
pub mod slider;
pub mod trig;
