//! A board on USB to live with: `lizard console`, `calibrate`, `backup`, `restore`,
//! `record`; and `replay`.
//!
//! What is done is kept apart from the terminal and from the serial port, so that it
//! is tested without either: against the firmware's core on this machine, and with
//! scripted input.

pub mod backup;
pub mod calibrate;
pub mod calibration;
pub mod connect;
#[cfg(test)]
mod double;
pub mod file;
pub mod find;
mod history;
pub mod interactive;
pub mod link;
pub mod port;
pub mod prompt;
pub mod recorder;
mod refusals;
#[cfg(feature = "simulator")]
pub mod replay;
mod screen;
pub mod session;
pub mod status;
mod terminal;
mod turn_error;
