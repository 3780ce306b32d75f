//! Helpers that several commands use: files, errors, the robot file, JSON, the colours and
//! shapes of pictures, and computations spread over machines.

pub mod failure;
pub mod files;
#[cfg(any(feature = "simulator", feature = "console"))]
pub mod firmware;
pub mod ink;
pub mod json;
pub mod number;
pub mod plain;
pub mod pose_args;
pub mod progress;
pub mod robot_file;
pub mod spread;
pub mod suggestion;
