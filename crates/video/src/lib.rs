//! Measures the robot's motion in a video: how far it moves in a cycle, and how accurate the result is.
//!
//! A camera looks down on the robot from any direction. Tags on the floor show the camera's pose, and a tag at a known
//! height on the robot's deck shows the robot's pose. [`sheet`] defines the printed sheet of tags.
//! - [`Video::add_frame`] detects the tags in each frame (`tags.rs`).
//! - [`Video::analyse`] finds the camera's pose (`scene.rs`) and the robot's path (`path.rs`).
//! - [`AnalysedVideo::find_walks`] finds the walks between the robot's rests (`walks.rs`).
//! - [`AnalysedVideo::match_gait`] finds the gait of a walk (`gait_match.rs`).
//! - [`AnalysedVideo::measure`] computes a walk's cycles (`cycles.rs`, `cycle_timing.rs`), their mean with its error
//!   (`mean.rs`), and the path within a cycle (`cycle_path.rs`).
//!
//! Two other measurements use the same tags: [`MeasuredSlide`] measures the friction of the pads, and [`MeasuredServo`]
//! the response of a single servo. The crate reads no file and prints nothing.
//!
//! # When not to use it
//! The crate measures one robot in one plane. For positions in space, or for many markers, use AprilTag's own library.
//!
//! # Units
//! mm, s, and px from the centre of a frame's top left pixel. A heading is in radians, a turn in degrees; both are
//! counter-clockwise as seen from above.

mod analysed_video;
mod blobs;
mod camera;
mod cycle_path;
mod cycle_timing;
mod cycles;
#[cfg(feature = "decode")]
mod decode;
mod edges;
mod estimate;
mod frame;
mod frame_tags;
mod gait;
mod gait_match;
mod homography;
mod least_squares;
mod mean;
mod measured_gait;
mod measured_servo;
mod measured_slide;
mod path;
mod rates;
mod scene;
pub mod servo_commands;
mod servo_error;
pub mod sheet;
mod tags;
mod video;
mod video_error;
mod walk;
mod walks;

pub use analysed_video::{AnalysedVideo, CameraEstimate};
pub use cycle_path::CyclePoint;
pub use estimate::Estimate;
pub use frame::{Frame, Pixel};
pub use gait::Gait;
pub use gait_match::GaitMatch;
pub use mean::Mean;
pub use measured_gait::MeasuredGait;
pub use measured_servo::{DeadBand, Jig, MeasuredServo};
pub use measured_slide::{MeasuredSlide, SlideError};
pub use path::PathPoint;
pub use servo_error::ServoError;
pub use tags::{Tag, read_tags};
pub use video::{Setup, Video};
pub use video_error::VideoError;
pub use walks::min_rest_duration;
