//! The commands for making the robot: drawings of the robot and its wiring, files of its parts for printing and
//! cutting, the proof that the parts fit, and models for other programs.

pub mod draw;
#[cfg(feature = "parts")]
pub mod model;
#[cfg(feature = "parts")]
pub mod parts;
