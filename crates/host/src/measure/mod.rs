//! Measure the real robot: a sheet of tags to print, and the way of a gait in a film.

mod command;
mod frames;
mod grey;
mod sheet;
mod through_ffmpeg;

pub use command::{Args, run};
pub use sheet::{SheetArgs, write_sheet};
