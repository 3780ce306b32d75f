//! The robot measured by the page's camera, with the same film and report as by `lizard measure`.
//!
//! A browser hands over pictures, one by one, with their times; it gets back the tags that each shows. Afterwards it
//! asks for the report of the gaits that the robot walked meanwhile. [`Camera`] holds the film; [`PageCamera`] is its
//! class for JavaScript. It is a WebAssembly module of its own, which the page loads only when needed.
//!
//! # When not to use it
//! The interface is made for this page and changes with it. A program in Rust uses `lizard-film` and `lizard-measure`.

mod camera;
mod javascript;

pub use camera::{Asked, AskedWalk, Camera, Refused, Results, TagEntry};
pub use javascript::PageCamera;
