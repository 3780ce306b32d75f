//! Measure the real robot: a sheet of tags to print, the way of a gait in a film, and the keys of robot.toml that ways tell.

mod command;
mod expected;
mod frames;
mod grey;
mod keys;
mod keys_report;
mod page;
mod report;
mod sheet;
mod through_ffmpeg;

pub use command::{Args, run};
pub use keys::{KeysArgs, find_keys};
pub use sheet::{SheetArgs, write_sheet};
