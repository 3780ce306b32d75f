//! Gaits in floating point, as robot.toml defines them.
//!
//! A gait is a movement that four legs repeat, each with its own phase. An author defines it by a waveform, by the
//! path of the head or the tail, or by another gait with changes. Here each definition becomes the sweep of each
//! leg at any phase, the reference for tables, pulses and predictions.

mod bars;
pub(crate) mod define;
mod gait;
mod path;
mod path_leg;
pub(crate) mod routine;
mod waveform;

pub use bars::Bars;
pub(crate) use gait::Gait;
pub use gait::Stride;
pub use path::{Harmonic, Path};
pub use path_leg::PathLeg;
pub use routine::Routine;
pub use waveform::Waveform;
pub(crate) use waveform::canonicalize;

/// Returns the console command that starts the gait or routine of this name: hyphens become spaces.
pub fn command_of(name: &str) -> String {
    name.replace('-', " ")
}
