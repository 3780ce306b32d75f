//! The page's robot: everything that the browser computes about a robot. This crate has almost no formulas of its own;
//! it calls the project's other crates.
//!
//! The page passes the text of a robot.toml and then, fifty times per second, the four pulse widths at a UNO's pins. It
//! receives the position of every joint, the margin to every singularity, the limit that the pose violates, if any, and
//! the body's place on the floor. [`Page`] holds this state; [`Robot`] is its JavaScript class.
//!
//! # When not to use it
//! The interface is made for this page and changes with it. A Rust program uses `lizard-robot` and `lizard-twin`
//! directly; another page can take [`Robot`] as an example.

mod calibration;
mod core_run;
mod description;
mod drawn;
#[cfg(feature = "tune")]
mod faster;
mod floor;
mod javascript;
mod lengths;
mod map;
mod page;
#[cfg(test)]
mod paper;
mod place;
mod prediction;
mod refused;
mod reports;
mod round;
mod scene;
mod trial;
mod workspace;

pub use core_run::{CoreFrame, CoreRun};
pub use description::{
    Description, GaitEntry, LinkEntry, MarginEntry, ServoEntry, ServoModelEntry,
};
pub use drawn::DrawnGait;
#[cfg(feature = "tune")]
pub use faster::{FasterSearch, Found, Progress, SearchExtent, SearchTask};
pub use floor::{Floor, LegDrive};
pub use javascript::Robot;
pub use lengths::{NearestLengths, TriedLengths, WithoutGait};
pub use map::{Curve, MapPoint, SingularityMap};
pub use page::{Edited, Frame, Page};
pub use place::Place;
pub use prediction::{Displacement, GaitPrediction};
pub use refused::Refused;
pub use round::RoundPath;
pub use scene::{LegScene, Margin, Point, Scene, SliderScene};
pub use trial::{Alternative, EditedGait, RefusedTrial, Trial};
pub use workspace::Workspace;
