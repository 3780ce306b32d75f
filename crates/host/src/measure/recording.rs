//! The options that describe how videos were recorded, and the ranges of their values.

use std::path::Path;

use lizard_measure::NamedVideo;
use lizard_video::{Setup, sheet};

use super::video;
use crate::Failure;

/// Allowed length of the printed ruler, which should be 100 mm long, mm.
const RULER_RANGE: [f64; 2] = [85.0, 115.0];

/// The options that describe how videos were recorded.
#[derive(clap::Args, Debug)]
pub(super) struct RecordingArgs {
    /// Frames per second [default: from the video, or from the frames' file names, such as 1.033s.png]
    #[arg(long, value_name = "RATE", value_parser = parse_rate)]
    fps: Option<f64>,
    /// Length of the line on a strip that should be 100 mm long
    #[arg(long, value_name = "MM", default_value_t = sheet::RULER_LENGTH, value_parser = parse_ruler)]
    ruler: f64,
}

impl RecordingArgs {
    /// Returns the setup of a video. `deck_height` is the height of the card's tag above the strips, mm.
    pub(super) fn setup(&self, deck_height: f64) -> Setup {
        Setup {
            print_scale: self.ruler / sheet::RULER_LENGTH,
            deck_height,
        }
    }

    /// Reads a video, and finds the camera and the robot's path in it.
    ///
    /// # Errors
    /// Fails if the video cannot be read, or if its tags show no path.
    pub(super) fn analyse(&self, path: &Path, setup: Setup) -> Result<NamedVideo, Failure> {
        video::analyse(path, self.fps, setup)
    }
}

/// Parses a number in a range. `unit` is for the error message.
pub(super) fn parse_number(text: &str, [min, max]: [f64; 2], unit: &str) -> Result<f64, String> {
    let number = text
        .parse()
        .ok()
        .filter(|value| (min..=max).contains(value));
    number.ok_or_else(|| format!("must be between {min} and {max} {unit}"))
}

fn parse_rate(text: &str) -> Result<f64, String> {
    parse_number(text, [1.0, 1000.0], "frames per second")
}

pub(super) fn parse_height(text: &str) -> Result<f64, String> {
    parse_number(text, [0.0, 500.0], "mm")
}

fn parse_ruler(text: &str) -> Result<f64, String> {
    parse_number(text, RULER_RANGE, "mm")
}
