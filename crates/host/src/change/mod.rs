//! The commands for changing the robot's gaits and measures: they write a new robot.toml, check its gaits, search for
//! faster ones, and prove that the firmware's guard judges every pose correctly.

pub mod gaits;
pub mod new;
#[cfg(feature = "paper")]
pub mod prove;
#[cfg(all(feature = "simulator", feature = "paper"))]
pub mod tune;
