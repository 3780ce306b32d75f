//! The robot's bodies for the web page: the printed parts, as `lizard parts` writes them, and the bought bodies.
//!
//! A browser that shows the robot in 3D needs the triangles once and then, for each frame, the position of every body.
//! Bodies that move together share a mount, a moving frame; therefore a rotation and a translation in the plane for
//! each mount are enough for any number of bodies. [`Model`] computes the triangles, the positions, the files to print,
//! to cut and to read, and the proof that no two bodies come too close; [`Parts`] is its JavaScript class. This crate
//! is a separate WebAssembly module, which the page loads only when needed.

mod javascript;
mod model;
mod solids;

pub use javascript::{PartFile, Parts};
pub use model::{BodyEntry, GuideStepEntry, Model, ModelDescription, PartEntry, Refusal};
pub use solids::Triangles;
