//! The page's work on a board: writing the firmware and the robot, and calibrating the servos.
//!
//! The page provides the serial line (of Web Serial or of its simulated UNO) and the clock: as a [`SerialLine`] for an
//! upload, and as a [`Console`] for a calibration. This crate is a separate WebAssembly module, which the page loads
//! when it writes to a board, identifies it or reads its calibration.
//!
//! # When not to use it
//! The interface is made for this page and changes with it. A Rust program uses `lizard-upload` and
//! `lizard-calibrate`.

mod calibration;
mod calibrator;
mod console;
mod line;
mod upload;

pub use calibration::read_calibration;
pub use calibrator::Calibrator;
pub use console::Console;
pub use line::SerialLine;
pub use upload::{Board, identify, is_lizard, needs_uno, parse_image, upload};
