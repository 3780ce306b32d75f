//! The commands for a board on USB: they list ports, write the firmware, open the robot's console, calibrate the robot,
//! save its settings, and replay a recorded session.

mod clock;
pub mod console;
pub mod flash;
pub mod image;
pub mod ports;
