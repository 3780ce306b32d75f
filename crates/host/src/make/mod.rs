//! Make the robot: drawings of it and of its wiring, its parts as files to print and to cut,
//! and the proof that they fit.

pub mod draw;
#[cfg(feature = "parts")]
pub mod parts;
