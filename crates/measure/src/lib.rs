//! Comparison of filmed gaits with their predictions, for the program `lizard` and for the web page.
//!
//! A film shows how far the robot moves in a cycle; by itself that says little. [`expected`] is the path that a
//! gait should take, which the film is compared with. [`Report`] sets both side by side, as a table or as JSON, and
//! [`WatchedFilm::path`] is the filmed path as CSV. [`Paper::sheet`] is the sheet of tags that a film has to show,
//! and [`height_of_board`] is the height of the robot's card. The crate reads no file and prints nothing.
//!
//! # When not to use it
//! For a path without a prediction, `lizard_film` is enough.

mod board;
mod engine;
mod expected;
mod named;
mod part;
mod range;
mod report;
mod sheet;
mod watched_film;

pub use board::height_of_board;
pub use expected::expected;
pub use named::{Gaits, NamedWalk};
pub use part::{MAX_AGREEING_ERRORS, PARTS, Part, verdict};
pub use report::{GaitReport, PhasePoint, Report};
pub use sheet::Paper;
pub use watched_film::WatchedFilm;
