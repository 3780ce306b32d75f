//! Run the firmware on a simulated UNO: its pulses, where they take the robot, and how long
//! its functions take.

pub mod bench;
pub mod board;
#[cfg(feature = "parts")]
pub mod course;
pub mod patrol;
pub mod sim;
pub mod twin;
