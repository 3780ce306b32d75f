//! The checks that every gait must pass before it may be walked.
//!
//! One bad sample of one gait can lock the linkage or strip a servo's gears. So every sample is solved as the
//! firmware will send it, with the robot's true lengths and with the core's own integers. A gait that passes is a
//! [`CheckedGait`]: it may be walked, and the contact model predicts its movement.

mod accuracy;
mod audit;
mod checked_gait;
mod effort;

pub use accuracy::TableError;
pub use audit::{Audit, LeastMargin, Peak};
pub use checked_gait::{CheckedGait, SimulatedCycle};
pub use effort::{Effort, HIGH_LINE_SHARE};
