//! The commands for changing the robot's gaits and dimensions: they write a new robot.toml, check its gaits, search
//! for faster gaits, and prove that the firmware's guard decides every pose correctly.

pub mod gaits;
pub mod new;
#[cfg(feature = "paper")]
pub mod prove;
#[cfg(all(feature = "simulator", feature = "paper"))]
pub mod tune;
