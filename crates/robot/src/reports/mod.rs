//! Tables of a robot's gaits for people to read.
//!
//! An author of a gait asks for three things: its distance from the limits, its movement, and
//! the effect of another floor, other feet or softer legs. Each is a table.

mod report;
mod sensitivity;
mod sprung;

pub use report::{Report, Row, UNDECIDED};
pub use sensitivity::Sensitivity;
pub use sprung::Sprung;
