//! Drive a board on USB: list the ports, write the firmware, open its console, calibrate it, save its
//! settings, and replay a recorded session.

pub mod console;
mod deadline;
pub mod flash;
pub mod image;
pub mod ports;
