//! The commands for a board on USB (`lizard console`, `info` and `calibrate`), and the session, link and terminal that
//! they share.
//!
//! The logic is separate from the terminal and the serial port, so the tests use scripted input and the firmware's core
//! on the host.

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
