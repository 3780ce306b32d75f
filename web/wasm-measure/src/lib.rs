//! Measures how a robot walks in a video of the page's camera, with the same analysis and report as `lizard measure`.
//!
//! The page passes each frame with its time and gets the tags found in it. At the end it requests the report on the
//! gaits that the robot has walked. [`Camera`] stores the video; [`PageCamera`] is its JavaScript class, `Camera`. This
//! crate is a WebAssembly module of its own, which the page loads only when needed.
//!
//! # When not to use it
//! The interface is made for this page and changes with it. Programs in Rust should use `lizard-video` and
//! `lizard-measure`.

mod camera;
mod javascript;

pub use camera::{Camera, MeasureRequest, RequestedWalk, Results, TagEntry};
pub use javascript::PageCamera;
