//! Gaits as robot.toml defines them, in floating point.
//!
//! A gait is four legs that repeat a movement, each at a phase of its own. An author writes
//! it as a stroke, as the path of the head or the tail, or as another gait with changes. Here
//! each becomes the sweep of a leg at any phase, the reference for tables, pulses and
//! predictions.

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
pub(crate) use waveform::canonical;
