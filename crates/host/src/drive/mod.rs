//! The commands for a board on USB: they list ports, write the firmware, report the robot's state, open its console,
//! calibrate it, save its settings, and replay a recorded session.

mod clock;
pub mod console;
pub mod flash;
pub mod image;
pub mod ports;
