//! The page's work on a board: writing the firmware and the robot, and calibrating the servos.
//!
//! The page provides the serial line (by Web Serial, or to its simulated UNO) and the clock: as a [`SerialLine`] for an
//! upload, and as a [`Console`] for a calibration. This crate is a WebAssembly module of its own, which the page loads
//! when it writes to a board, identifies one, or reads its calibration.
//!
//! # When not to use it
//! The interface is made for this page and changes with it. A program in Rust uses `lizard-upload` and
//! `lizard-calibrate`.
#![deny(unsafe_code)]
#![deny(missing_docs)]
#![warn(clippy::missing_errors_doc)]

mod calibration;
mod console;
mod guide;
mod line;
mod upload;

pub use calibration::read_calibration;
pub use console::Console;
pub use guide::Guide;
pub use line::SerialLine;
pub use upload::{Board, identify, image_of, is_lizard, needs_uno, upload};
