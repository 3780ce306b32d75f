//! What a checked robot's gaits are like, for people to read.
//!
//! An author of a gait asks three things: how far it is from the limits, how far it leads,
//! and what another floor, other feet or softer legs would change. Each is a table.

mod report;
mod sensitivity;
mod sprung;

pub use report::{Report, Row, UNDECIDED};
pub use sensitivity::{LEAVES, LONG, MOUNTS, PLAYS, RATIOS, Sensitive, Sensitivity, TWISTS};
pub use sprung::Sprung;
