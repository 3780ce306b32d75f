//! The options that describe how films were taken, and the ranges of their values.

use std::path::Path;

use lizard_film::{Setup, sheet};
use lizard_measure::NamedFilm;

use super::film;
use crate::Failure;

/// Range of the length that the printed ruler of 100 mm may have, mm.
const RULER_RANGE: [f64; 2] = [85.0, 115.0];

/// The options that describe how films were taken.
#[derive(clap::Args, Debug)]
pub(super) struct Filming {
    /// Pictures per second [default: from the film, or from the names of pictures, such as 1.033s.png]
    #[arg(long, value_name = "RATE", value_parser = parse_rate)]
    fps: Option<f64>,
    /// Length of the line on a strip that should be 100 mm long
    #[arg(long, value_name = "MM", default_value_t = sheet::RULER_LENGTH, value_parser = parse_ruler)]
    ruler: f64,
}

impl Filming {
    /// The setup of a film, with the scale of the printed sheet; `height` is that of the tag above the strips, mm.
    pub(super) fn setup(&self, height: f64) -> Setup {
        Setup {
            print_scale: self.ruler / sheet::RULER_LENGTH,
            deck_height: height,
        }
    }

    /// Reads a film, and finds the camera and the robot's path in it.
    ///
    /// # Errors
    /// Fails for a film that cannot be read, or one whose tags show no path.
    pub(super) fn analyse(&self, path: &Path, setup: Setup) -> Result<NamedFilm, Failure> {
        film::analyse(path, self.fps, setup)
    }
}

/// Parses a number in a range. The error text states `meaning` and the range.
pub(super) fn parse_number(
    text: &str,
    [low, high]: [f64; 2],
    meaning: &str,
) -> Result<f64, String> {
    let number = text
        .parse()
        .ok()
        .filter(|value| (low..=high).contains(value));
    number.ok_or_else(|| format!("{meaning}, between {low} and {high}"))
}

fn parse_rate(text: &str) -> Result<f64, String> {
    parse_number(text, [1.0, 1000.0], "it is a number of pictures per second")
}

pub(super) fn parse_height(text: &str) -> Result<f64, String> {
    parse_number(text, [0.0, 500.0], "it is a height in mm")
}

fn parse_ruler(text: &str) -> Result<f64, String> {
    parse_number(
        text,
        RULER_RANGE,
        "it is the line of 100 mm as a ruler measures it in mm",
    )
}
