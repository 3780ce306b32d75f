//! The program `lizard`. Its modules follow the user's tasks: editing robot.toml (`change`), making parts (`make`),
//! controlling a board (`drive`), measuring videos (`measure`), reproducing the paper's results (`paper`) and
//! simulating (`simulate`). `commands` contains the table of commands, `shared` the helpers of several commands.

mod change;
pub mod commands;
#[cfg(feature = "console")]
mod drive;
mod make;
#[cfg(feature = "parts")]
mod measure;
#[cfg(feature = "paper")]
mod paper;
mod shared;
#[cfg(feature = "simulator")]
mod simulate;

pub use shared::escape::make_readable;
pub use shared::failure::Failure;
pub use shared::pose_args::PoseArgs;
pub use shared::robot_args::RobotArgs;

// Modules that tests and other crates use.
#[cfg(feature = "console")]
pub use drive::{console::session, flash};
pub use make::draw;
#[cfg(any(feature = "simulator", feature = "console"))]
pub use shared::firmware;
#[cfg(feature = "simulator")]
pub use simulate::{bench, board, patrol, sim, twin};
