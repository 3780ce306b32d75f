//! The checks that every gait must pass before it may be walked.
//!
//! One bad sample of one gait can lock the linkage or strip a servo's gears. So every sample is checked as the
//! firmware will send it, both in floating point and in the core's own integers. A gait that passes is a
//! [`CheckedGait`]: it may be walked, and the contact model can predict its movement.

mod accuracy;
mod audit;
mod checked_gait;
mod effort;

pub use accuracy::TableError;
pub use audit::{Audit, LeastMargin, PeakSpeed};
pub use checked_gait::{CheckedGait, SimulatedCycle};
pub use effort::{Effort, HIGH_LINE_SHARE};
