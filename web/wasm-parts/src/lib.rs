//! The robot's parts for the page: the same solids that `lizard parts` writes.
//!
//! A browser that shows the robot in 3D needs the triangles once and then, for each frame, the
//! pose of every body. Bodies that move together share a mount, so a pose is one rotation and one
//! translation in the plane for each mount, however many parts there are. [`Model`] computes the
//! triangles, the poses, the files to print, to cut and to read, and the proof that no two parts
//! come too close; [`Parts`] is its class for JavaScript. This crate is a WebAssembly module of its
//! own, which the page loads only when needed.
#![deny(unsafe_code)]
#![deny(missing_docs)]
#![warn(clippy::missing_errors_doc)]

mod javascript;
mod model;
mod solids;

pub use javascript::{PartFile, Parts};
pub use model::{BodyEntry, Model, ModelEntry, PartEntry, Refused, StepEntry};
pub use solids::Triangles;
