//! Change the robot's gaits and measures: check the gaits of a robot.toml, search faster
//! ones, and prove that the firmware's guard holds for it.

pub mod gaits;
pub mod new;
#[cfg(feature = "paper")]
pub mod prove;
#[cfg(all(feature = "simulator", feature = "paper"))]
pub mod tune;
