//! The calibration of a robot over its console: the lines that each step sends, and their order.
//!
//! A longer pulse turns a servo in one direction or the other, by more or less than its data sheet says, and a horn
//! fits its spline only at certain angles. So a person watches the robot while a single servo turns, and enters the
//! observation. [`Guide`] makes the movements, and computes the settings from the answers. Nothing is saved before
//! [`Guide::save`], and [`Guide::restore`] returns to the saved settings.
//!
//! The crate has no serial port, screen or clock: this machine or a browser provides the connection, a [`Console`]. Its
//! functions are `async`, since a browser cannot block; for a console that blocks, any executor will do.
//!
//! # When not to use it
//! To send one setting, use a line of the console. The crate cannot see the robot: a person must tell it what a servo
//! does.
#![deny(unsafe_code)]
#![warn(clippy::missing_errors_doc)]

mod console;
mod exchange;
mod guide;
mod still;

pub use console::{BadReply, Console, ConsoleError, Reply, send_command};
pub use exchange::{SendError, read_settings, replace_settings, send_settings};
pub use guide::{Guide, SCALE_TURNS_DEG, SIGN_TURNS_DEG};
