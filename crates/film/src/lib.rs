//! Measuring the robot in a film: how far it moves in a cycle, and how accurate the result is.
//!
//! A camera looks down on the robot from any place. Tags on the floor show where the camera is, and a tag on the
//! deck, whose height is known, shows where the robot is ([`sheet`] has the sheet of tags). [`Film::add`] reads the
//! tags of each picture. [`Film::watch`] finds the camera (`scene.rs`) and the path (`path.rs`). [`AnalysedFilm::walks`]
//! finds the walks between the robot's rests (`walks.rs`), [`AnalysedFilm::likeness`] the gait of a walk (`likeness.rs`).
//! [`AnalysedFilm::measure`] finds the cycles of a walk (`cycles.rs`, `clock.rs`), their mean with its error (`mean.rs`)
//! and the path within them (`within.rs`). Two other measurements use the same tags: [`Slide`] is the friction of the
//! pads, and [`Turns`] is the response of a single servo. The crate reads no file and prints nothing.
//!
//! # When not to use it
//! It measures one robot in one plane. For positions in space, or for many markers, use AprilTag's own library.
//!
//! # Units
//! mm, s, and px from the middle of a picture's top left pixel; a heading is in radians, a turn in degrees, both
//! counter-clockwise as seen from above.

mod blobs;
mod camera;
mod clock;
mod cycles;
mod edges;
mod figure;
mod film;
mod frame;
mod gait;
mod homography;
mod least;
mod likeness;
mod mean;
mod measured;
pub mod orders;
mod path;
mod picture;
mod scene;
pub mod sheet;
mod slide;
mod spin;
mod tags;
mod trouble;
mod turns;
mod turns_trouble;
mod walk;
mod walks;
mod watched;
mod within;

pub use figure::Figure;
pub use film::{Film, Setup};
pub use gait::Gait;
pub use likeness::Likeness;
pub use mean::Mean;
pub use measured::Measured;
pub use path::PathPoint;
pub use picture::{Picture, Pixel, luminance};
pub use slide::{Slide, SlideTrouble};
pub use tags::{Tag, read};
pub use trouble::Trouble;
pub use turns::{DeadBand, Jig, Turns};
pub use turns_trouble::TurnsTrouble;
pub use walks::rest;
pub use watched::{AnalysedFilm, Sight};
pub use within::Point;
