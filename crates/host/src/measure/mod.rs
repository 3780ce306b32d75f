//! Measurements of the real robot in films: the movement per cycle of gaits, the keys of robot.toml identified from
//! such movements, a servo in a jig, and friction on a slope; and the sheet of tags that the films must show.

mod command;
mod figures;
mod film;
mod filming;
mod frames;
mod keys;
mod keys_report;
mod picture;
mod servo;
mod sheet;
mod slope;
mod steps;
mod through_ffmpeg;

pub use command::{Args, run};
pub use keys::{KeysArgs, find_keys};
pub use servo::{ServoArgs, measure_servo};
pub use sheet::{SheetArgs, write_sheet};
pub use slope::{SlopeArgs, measure_slope};
pub use steps::{StepsArgs, print_steps};
