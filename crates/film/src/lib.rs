//! Measuring the robot in a film: how far it moves in a cycle, and how accurate the result is.
//!
//! A camera looks down on the robot from anywhere. Tags on the floor show where the camera is, and a tag on the robot's
//! deck, whose height is known, shows where the robot is ([`sheet`] defines the printed sheet of tags). [`Film::add`]
//! reads the tags of each picture. [`Film::analyse`] finds the camera (`scene.rs`) and the robot's path (`path.rs`).
//! [`AnalysedFilm::walks`] finds the walks between the robot's rests (`walks.rs`), and [`AnalysedFilm::match_gait`] the
//! gait of a walk (`gait_match.rs`). [`AnalysedFilm::measure`] finds the cycles of a walk (`cycles.rs`, `clock.rs`),
//! their mean with its error (`mean.rs`) and the path within a cycle (`cycle_path.rs`). Two other measurements use the
//! same tags: [`Slide`] is the friction of the pads, and [`MeasuredServo`] is the response of a single servo. The crate
//! reads no file and prints nothing.
//!
//! # When not to use it
//! The crate measures one robot in one plane. For positions in space, or for many markers, use AprilTag's own library.
//!
//! # Units
//! mm, s, and px from the middle of a picture's top left pixel; a heading is in radians, a turn in degrees, both
//! counter-clockwise as seen from above.

mod analysed_film;
mod blobs;
mod camera;
mod clock;
mod cycle_path;
mod cycles;
#[cfg(feature = "decode")]
mod decode;
mod edges;
mod figure;
mod film;
mod frame;
mod gait;
mod gait_match;
mod homography;
mod least_squares;
mod mean;
mod measured_gait;
mod measured_servo;
pub mod orders;
mod path;
mod picture;
mod rates;
mod scene;
mod servo_trouble;
pub mod sheet;
mod slide;
mod tags;
mod trouble;
mod walk;
mod walks;

pub use analysed_film::{AnalysedFilm, CameraEstimate};
pub use cycle_path::CyclePoint;
pub use figure::Figure;
pub use film::{Film, Setup};
pub use gait::Gait;
pub use gait_match::GaitMatch;
pub use mean::Mean;
pub use measured_gait::MeasuredGait;
pub use measured_servo::{DeadBand, Jig, MeasuredServo};
pub use path::PathPoint;
pub use picture::{Picture, Pixel};
pub use servo_trouble::ServoTrouble;
pub use slide::{Slide, SlideTrouble};
pub use tags::{Tag, read_tags};
pub use trouble::Trouble;
pub use walks::shortest_rest;
