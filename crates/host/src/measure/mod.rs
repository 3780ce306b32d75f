//! Measure the real robot: a sheet of tags to print, and the ways of gaits in films.

mod command;
mod expected;
mod film;
mod frames;
mod grey;
mod named;
mod page;
mod picture;
mod report;
mod sheet;
mod through_ffmpeg;

pub use command::{Args, run};
pub use sheet::{SheetArgs, write_sheet};
