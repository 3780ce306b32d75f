//! Measurements of the real robot in videos: displacements per cycle, the resulting keys of robot.toml, a servo in a
//! jig, and friction on a slope. Also writes the sheet of tags that the videos must show.

mod command;
mod ffmpeg;
mod frames;
mod keys;
mod keys_report;
mod measured_key;
mod picture;
mod recording;
mod servo;
mod sheet;
mod slope;
mod steps;
mod video;

pub use command::{Args, run};
pub use keys::{KeysArgs, identify_keys};
pub use servo::{ServoArgs, measure_servo};
pub use sheet::{SheetArgs, write_sheet};
pub use slope::{SlopeArgs, measure_slope};
pub use steps::{StepsArgs, print_steps};
