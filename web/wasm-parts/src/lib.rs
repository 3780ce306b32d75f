//! The robot's parts for the page: the very solids that `lizard parts` writes.
//!
//! A browser that shows the robot in space needs triangles once and then, for each picture, where
//! everything is. All bodies that move together share a mount, so a pose is as many turns
//! and shifts in the plane as there are mounts, whatever the number of parts. Here are both, the
//! files to print, cut and read, and the proof that nothing meets; [`Model`] holds them, `abi`
//! is the door to JavaScript. It is a module apart from the page's first one, since most
//! visitors never ask for it.
#![deny(unsafe_code)]
#![deny(missing_docs)]
#![warn(clippy::missing_errors_doc)]

mod abi;
mod model;
mod solids;

pub use model::{BodyEntry, Model, ModelEntry, PartEntry, Refused, StepEntry};
