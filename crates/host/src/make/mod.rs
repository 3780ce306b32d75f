//! The commands for making the robot: drawings of it and of its wiring, its parts as files to print and to cut, the
//! proof that they fit, and models of it for other programs.

pub mod draw;
#[cfg(feature = "parts")]
pub mod model;
#[cfg(feature = "parts")]
pub mod parts;
