//! The program `lizard`, divided by what its user does. Each command is a module with its
//! `Args` and its `run`; `commands` has the table of them.

pub mod change;
pub mod commands;
#[cfg(feature = "console")]
pub mod drive;
pub mod make;
#[cfg(feature = "paper")]
pub mod paper;
pub mod shared;
#[cfg(feature = "simulator")]
pub mod simulate;

pub use shared::failure::Failure;
pub use shared::pose_args::PoseArgs;
pub use shared::robot_file::RobotFile;

// Modules that tests of other crates use.
#[cfg(feature = "paper")]
pub use change::prove;
#[cfg(feature = "console")]
pub use drive::flash;
#[cfg(any(feature = "simulator", feature = "console"))]
pub use shared::firmware;
#[cfg(feature = "simulator")]
pub use simulate::{bench, board, sim, twin};
