//! Comparison of filmed gaits with their predictions, for the program `lizard` and for the web page.
//!
//! A film shows how far the robot moves in a cycle, which alone says little. [`predict_gait`] computes the path that a
//! gait should take. [`Report`] sets the filmed path beside it, as a table or as JSON, and [`NamedFilm::path_csv`] is
//! the filmed path as CSV. [`Paper::tag_sheet_pdf`] is the sheet of tags that a film has to show, and [`board_height`]
//! is the height of the card on the robot's deck. The crate reads no file and prints nothing.
//!
//! # When not to use it
//! For a path without a prediction, `lizard_film` is enough.

mod board;
mod component;
mod engine;
mod gaits;
mod named_film;
mod predicted_gait;
mod range;
mod report;
mod sheet;

pub use board::board_height;
pub use component::{COMPONENT_NAMES, Component, MAX_AGREEING_ERRORS, verdict};
pub use gaits::{Gaits, MeasuredWalk};
pub use named_film::NamedFilm;
pub use predicted_gait::predict_gait;
pub use report::{GaitReport, PhasePoint, Report};
pub use sheet::Paper;
