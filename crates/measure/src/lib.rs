//! Compares recorded gaits with their predictions, for the program `lizard` and for the web page.
//!
//! A video shows how far the robot moves in a cycle, but this distance means little without a prediction.
//! [`predict_gait`] computes the path that a gait should take. [`Report`] compares the recorded path with it, as a
//! table or as JSON, and [`NamedVideo::format_path_csv`] formats the recorded path as CSV.
//! [`PaperSize::draw_tag_sheet`] draws the sheet of tags that a video must show, and [`compute_deck_height`] computes
//! the height of the robot's deck, on which its card lies. The crate reads no file and prints nothing.
//!
//! # When not to use it
//! For a path without a prediction, `lizard_video` is enough.

mod component;
mod deck;
mod gaits;
mod mujoco;
mod named_video;
mod predicted_gait;
mod prediction_range;
mod report;
mod sheet;

pub use component::{AGREEMENT_LIMIT, COMPONENT_LABELS, Component, format_verdict};
pub use deck::compute_deck_height;
pub use gaits::{Gaits, MeasuredWalk};
pub use named_video::NamedVideo;
pub use predicted_gait::predict_gait;
pub use report::{GaitReport, PhasePoint, Report};
pub use sheet::PaperSize;
