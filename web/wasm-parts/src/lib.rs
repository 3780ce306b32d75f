//! The robot's parts for the web page: the same solids that `lizard parts` writes.
//!
//! A browser that shows the robot in 3D needs the triangles once and then, for each frame, the position of every body.
//! Bodies that move together share a mount; therefore each mount needs only a rotation and a translation in the plane,
//! for any number of parts. [`Model`] computes the triangles, the positions, the files to print, to cut and to read,
//! and the proof that no two parts come too close; [`Parts`] is its JavaScript class. This crate is a separate
//! WebAssembly module, which the page loads only when needed.
#![deny(unsafe_code)]
#![deny(missing_docs)]
#![warn(clippy::missing_errors_doc)]

mod javascript;
mod model;
mod solids;

pub use javascript::{PartFile, Parts};
pub use model::{BodyEntry, Model, ModelDescription, PartEntry, Refusal, StepEntry};
pub use solids::Triangles;
