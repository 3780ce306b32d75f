//! The console: lines in, answers out.
//!
//! This module is the highest of the core's six layers: it reads bytes and lines, gives [orders](crate::control::order)
//! to the robot and prints the answers. A board without a serial port does not need it.

pub mod answer;
mod autobaud;
pub mod command;
mod dialogue;
pub mod digits;
pub mod line;
pub mod output;
mod print;
mod refusal;
pub mod text;
mod watch;
pub mod word;

pub use dialogue::{Console, MAX_OUTPUT_LINE_BYTES};
