//! A digital twin of the robot: the movement of body, legs and feet that a board's servo pulses cause.
//!
//! The four pulses of a frame set the servos' targets ([`ServoModel`]), the servos turn the linkage, struts or springs
//! pull the legs, and the contact model (`lizard_contact`) computes the body's movement over the floor.
//! [`Twin::simulate_pulses`] simulates one frame and returns the [`State`] after it. The crate accesses no files and
//! prints nothing, so that a program, a test and a web page can use it.
//!
//! # When not to use it
//! The model is planar: feet do not lift or tilt, and links do not bend. Where this matters, `lizard model` writes the
//! robot for a physics engine. For a gait's movement without pulses and servos, `lizard_robot::CheckedGait::predict` is
//! sufficient.
//!
//! # Units
//! mm, degrees, seconds and microseconds, as each item's documentation states; a heading is in radians. Every array has
//! the servo order A1, A2, A3, A4, which is the leg order left front, right front, right hind, left hind. Points on the
//! floor are (forward, left) relative to the robot's start. Points of a [`Shape`] are in the chassis frame of
//! `lizard_kinematics`: x to the robot's right, y forward.

mod servo;
mod shape;
mod state;
mod totals;
mod twin;

pub use servo::ServoModel;
pub use shape::Shape;
pub use state::State;
pub use totals::Totals;
pub use twin::Twin;

/// Time from one frame to the next, s.
pub const FRAME_PERIOD_S: f64 = 1.0 / lizard_robot::FRAMES_PER_SECOND;
