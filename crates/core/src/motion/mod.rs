//! Motion: turns a gait or a target pose into the pose of each frame.
//!
//! [`Motion`] connects gaits and moves so that no servo jumps. Every pose passes the [guard](crate::guard) before it is
//! sent.

mod frames;
pub mod gait;
mod pace;
pub mod point_to_point;
mod state;

pub use frames::{AWAKE_FRAMES, Motion};
pub use state::Activity;
