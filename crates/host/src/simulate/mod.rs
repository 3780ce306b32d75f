//! Commands that run the firmware on a simulated UNO and report the servo pulses, the robot's path, and the execution
//! times of functions.

pub mod bench;
pub mod board;
pub mod patrol;
pub mod sim;
#[cfg(feature = "parts")]
pub mod trajectory;
pub mod twin;
