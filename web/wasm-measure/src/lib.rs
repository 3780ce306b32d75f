//! The measurement of a walking robot by the page's camera, with the same analysis and report as `lizard measure`.
//!
//! A browser hands over pictures one by one, with their times, and gets back the tags that each of them shows.
//! Afterwards it requests the report of the gaits that the robot has walked. [`Camera`] holds the film; [`PageCamera`]
//! is its class for JavaScript. This crate is a WebAssembly module of its own, which the page loads only when needed.
//!
//! # When not to use it
//! The interface is made for this page and changes with it. A program in Rust uses `lizard-film` and `lizard-measure`.

mod camera;
mod javascript;

pub use camera::{Camera, MeasureRequest, Refused, RequestedWalk, Results, TagEntry};
pub use javascript::PageCamera;
