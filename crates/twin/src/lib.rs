//! Simulated twin of the robot: the movement of body, legs and feet that a board's servo pulses cause.
//!
//! The four pulses of a frame set the targets of the servos ([`ServoModel`]), the servos turn the linkage, struts or
//! springs pull the legs, and the contact model (`lizard_contact`) computes the movement of the body over the
//! floor. [`Twin::push`] takes one frame and returns the result as a [`State`]. The crate reads, stores and prints
//! nothing, so a program, a test and a web page can use it.
//!
//! # When not to use it
//! The model is planar: feet do not lift or tilt, and links do not bend. Where this matters, `lizard model` writes the
//! robot for a physics engine. For the movement of a gait without pulses and servos,
//! `lizard_robot::CheckedGait::predict` is enough.
//!
//! # Units
//! mm, degrees, seconds and microseconds, as their names say; a heading is in radians. Servo order A1, A2, A3, A4
//! in every array, which is legs LF, RF, RH, LH. Points on the floor are (forward, left) relative to the robot's
//! initial place; points of a [`Shape`] are in the chassis frame of `lizard_kinematics`: x to the robot's right, y
//! forward.

mod servo;
mod shape;
mod state;
mod tally;
mod twin;

pub use servo::{ServoModel, UnloadedServo};
pub use shape::Shape;
pub use state::State;
pub use tally::Tally;
pub use twin::Twin;

/// Time from one frame to the next, s.
pub const FRAME_S: f64 = 1.0 / lizard_robot::FRAMES_PER_SECOND;
