//! The motion: from a gait or a target to the pose of each frame.
//!
//! [`Motion`] joins gaits and moves so that no servo ever jumps; every pose passes the
//! [guard](crate::guard) before it is sent.

mod frames;
pub mod gait;
mod pace;
pub mod point_to_point;
mod state;

pub use frames::{AWAKE, Motion};
pub use state::Activity;
