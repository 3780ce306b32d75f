//! What the `lizard` program does, one module for each subcommand: its
//! `Args` and its `run`.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod bench;
pub mod draw;
mod failure;
pub mod gaits;
pub mod paper;
mod pose_args;
mod robot_file;
pub mod sim;

pub use failure::Failure;
pub use pose_args::PoseArgs;
pub use robot_file::RobotFile;
