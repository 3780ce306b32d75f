//! Gaits in floating point, and routines, which are sequences of gaits, as robot.toml defines them.
//!
//! A gait is a movement that four legs repeat, each with its own phase. robot.toml defines a gait by a waveform, by a
//! path of the head or the tail, or by changes to another gait. This module converts each definition to the sweep of
//! each leg at any phase, which is the reference for tables, pulses and predictions.

mod bars;
pub(crate) mod define;
mod gait;
mod path;
mod path_sweep;
pub(crate) mod routine;
mod waveform;

pub use bars::Bars;
pub(crate) use gait::Gait;
pub use gait::Stride;
pub use path::{Harmonic, Path};
pub use path_sweep::PathSweep;
pub use routine::Routine;
pub use waveform::Waveform;
pub(crate) use waveform::canonicalize;

/// Converts the name of a gait or routine to its console command: hyphens become spaces.
pub fn to_command(name: &str) -> String {
    name.replace('-', " ")
}
