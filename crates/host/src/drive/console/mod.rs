//! The commands for a board on USB (`lizard console`, `info` and `calibrate`), and their session, link and terminal.
//!
//! The logic is separate from the terminal and the serial port. The tests therefore use the firmware's core on this
//! machine and scripted input.

pub mod backup;
pub mod calibrate;
pub mod connect;
mod deadman;
mod dialogue_error;
mod history;
pub mod info;
pub mod interactive;
pub mod link;
pub mod port;
pub mod prompt;
pub mod recorder;
#[cfg(feature = "simulator")]
pub mod replay;
mod screen;
pub mod session;
mod terminal;
#[cfg(test)]
pub mod test_double;
pub mod usb_ports;
