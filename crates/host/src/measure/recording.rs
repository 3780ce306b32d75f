//! The options that describe how videos were recorded, and the ranges of their values.

use lizard_video::{Setup, sheet};

use crate::shared::number::range_parser;

/// The options that describe how videos were recorded.
#[derive(clap::Args, Debug)]
pub(super) struct RecordingArgs {
    /// Frames per second [default: from the video, or from the frames' file names, such as 1.033s.png]
    #[arg(long, value_name = "RATE", value_parser = range_parser(1.0, 1000.0, " frames per second"))]
    pub(super) fps: Option<f64>,
    /// Measured length of the 100 mm line on a printed strip
    #[arg(long, value_name = "MM", default_value_t = sheet::RULER_LENGTH,
          value_parser = range_parser(85.0, 115.0, " mm"))]
    ruler: f64,
}

impl RecordingArgs {
    /// Returns the setup of a video. `deck_height` is the height of the deck's tag above the strips, mm.
    pub(super) fn setup(&self, deck_height: f64) -> Setup {
        Setup {
            print_scale: self.ruler / sheet::RULER_LENGTH,
            deck_height,
        }
    }
}

/// Returns a clap parser for the height of the deck's tag or of a servo's card above the strips, mm.
pub(super) fn height_parser() -> impl Fn(&str) -> Result<f64, String> + Clone {
    range_parser(0.0, 500.0, " mm")
}
