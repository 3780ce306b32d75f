//! The robot behind its pulses: how body, legs and feet move when the board sends its
//! pulses.
//!
//! A frame's four pulses go to the servos ([`ServoModel`]: how fast they turn, and the
//! error that they leave), the servos turn the linkage, springs pull the legs along, and
//! the contact model (`lizard_contact`) computes how the body moves over the floor.
//! [`Twin::push`] takes one frame and returns the result as a [`State`]. The crate reads,
//! stores and prints nothing, so a program, a test and a web page can use it.
//!
//! # Units
//! mm, degrees, seconds and microseconds, as their names say; a heading is in radians.
//! Servo order A1, A2, A3, A4 in every array, which is legs LF, RF, RH, LH. Points on
//! the floor are (forward, left) as the robot stood at first; points of a [`Shape`] are
//! in the chassis frame of `lizard_kinematics`: x to the robot's right, y forward.

mod servo;
mod shape;
mod state;
mod tally;
mod twin;

pub use servo::ServoModel;
pub use shape::Shape;
pub use state::State;
pub use tally::Tally;
pub use twin::Twin;

/// Seconds from one frame to the next.
pub const FRAME: f64 = 1.0 / lizard_robot::FRAMES_PER_SECOND;
