//! The checks that every gait must pass before the robot may walk with it.
//!
//! A single bad sample can lock the linkage or strip a servo's gears. Every sample is therefore checked as the firmware
//! will send it, both in floating point and in the firmware's integer arithmetic. A gait that passes is a
//! [`CheckedGait`]: the robot may walk with it, and the contact model can predict its displacement.

mod accuracy;
mod audit;
mod checked_gait;
mod effort;

pub use accuracy::TableError;
pub use audit::{Audit, MinMargin, PeakSpeed};
pub use checked_gait::{CheckedGait, SimulatedCycle};
pub use effort::{Effort, HIGH_UTILISATION};
