//! Calibrates a robot over its console: the lines that each step sends, and their order.
//!
//! Servos differ in the direction in which a longer pulse turns them, and in the angle per microsecond; a horn fits its
//! spline only at certain angles. Therefore a person watches the robot while a single servo turns, and enters the
//! observation. [`Session`] makes the movements, and computes the settings from the observations. Nothing is saved
//! before [`Session::save`], and [`Session::restore`] returns to the saved settings.
//!
//! The crate has no serial port, screen or clock: the host program or the page provides the connection, a [`Console`].
//! The functions are `async`, because a browser cannot block; for a blocking console, any executor is suitable.
//!
//! # When not to use it
//! To change one setting, send a line to the console. The crate cannot see the robot: a person must enter each servo's
//! movement.
#![deny(unsafe_code)]
#![warn(clippy::missing_errors_doc)]

mod console;
mod session;
mod settings;
mod still;

pub use console::{Console, ConsoleError, Reply, ReplyError, send_command};
pub use session::{SCALE_TURNS_DEG, SIGN_TURNS_DEG, Session};
pub use settings::{ReplaceError, read_settings, replace_settings, send_settings};

/// The result of a line or a step.
type Result<T, C> = std::result::Result<T, ConsoleError<<C as Console>::Error>>;
