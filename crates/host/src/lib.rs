//! What the `lizard` program does, one module for each subcommand: its
//! `Args` and its `run`. `commands` has the table of them.

#[cfg(feature = "simulator")]
pub mod bench;
#[cfg(feature = "simulator")]
pub mod board;
pub mod commands;
#[cfg(feature = "console")]
pub mod console;
pub mod draw;
mod failure;
mod files;
#[cfg(any(feature = "simulator", feature = "console"))]
pub mod firmware;
#[cfg(feature = "console")]
pub mod flash;
pub mod gaits;
#[cfg(feature = "console")]
pub mod image;
mod json;
pub mod merge;
#[cfg(all(feature = "simulator", feature = "parts"))]
pub mod mjcf;
#[cfg(feature = "paper")]
pub mod paper;
#[cfg(feature = "parts")]
pub mod parts;
pub mod plain;
pub mod pose_args;
#[cfg(feature = "paper")]
pub mod prove;
mod robot_file;
#[cfg(feature = "simulator")]
pub mod sim;
pub mod spread;
mod suggestion;
#[cfg(all(feature = "simulator", feature = "paper"))]
pub mod tune;
#[cfg(feature = "simulator")]
pub mod twin;

pub use failure::Failure;
pub use pose_args::PoseArgs;
pub use robot_file::RobotFile;
