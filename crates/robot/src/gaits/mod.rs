//! Gaits as robot.toml defines them, in floating point.
//!
//! A gait is four legs that repeat a movement, each at a phase of its own. An author writes
//! it as a stroke, as a sine, as the path of the head or the tail, or as another gait with
//! changes. Here each becomes what a leg does at any phase: the truth that tables, pulses and
//! predictions are compared with.

pub(crate) mod define;
mod gait;
mod harmonic;
mod path;
mod path_leg;
mod waveform;

pub(crate) use gait::Gait;
pub use gait::Stride;
pub use harmonic::Harmonic;
pub use path::Path;
pub use path_leg::PathLeg;
pub use waveform::Waveform;
pub(crate) use waveform::canonical;
