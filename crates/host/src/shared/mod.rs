//! Helpers that several commands share: files, errors, the robot file, JSON, the colours and shapes of drawings, and
//! computations spread over machines.
#![cfg_attr(
    not(all(
        feature = "simulator",
        feature = "paper",
        feature = "console",
        feature = "parts"
    )),
    allow(dead_code, reason = "a build without a feature uses fewer helpers")
)]

pub mod displacement;
pub mod escape;
pub mod failure;
pub mod files;
#[cfg(any(feature = "simulator", feature = "console"))]
pub mod firmware;
pub mod json;
pub mod number;
pub mod plot;
pub mod pose_args;
pub mod progress;
pub mod quantity;
pub mod robot_args;
pub mod shapes;
pub mod spread;
pub mod suggestion;
