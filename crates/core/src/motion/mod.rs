//! Motion: computes the pose of each frame from a gait or a target pose.
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
