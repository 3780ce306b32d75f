//! Reads and checks robot.toml: the robot's measurements and gaits, for the host program,
//! the page, the firmware's build script and the tests.
//!
//! [`Robot::load`] reads the file and checks everything in it, including every sample of
//! every gait, so every `Robot` can walk. It gives the gaits in floating point together
//! with the tables that the firmware reads ([`CheckedGait`]), the robot in the integers
//! of the core ([`CoreRobot`]) and the section of flash that carries these to the board
//! ([`Robot::section`]).
//!
//! Inside, a file without its gaits becomes `Measures`. These and the gaits' `Tables`
//! become the integers, [`lizard_core::section::Content`]. A [`Robot`] holds all of them,
//! and a [`CoreRobot`] is what the core reads of them. docs/firmware.md lists the types
//! of other crates that also are a robot.

mod accuracy;
mod audit;
mod cells;
mod checked_gait;
mod coil;
mod core_robot;
mod define;
mod drive;
mod error;
mod feet;
mod file;
mod friction;
mod gait;
mod ground;
mod harmonic;
mod hips;
mod legs;
mod linear;
mod measure;
mod numbers;
mod parts;
mod path;
mod path_leg;
mod place;
mod plate;
mod prediction;
mod reader;
mod report;
mod robot;
mod scale;
mod sensitivity;
pub mod servo;
mod spring;
mod sprung;
mod stance;
mod strut;
mod supply;
mod syntax;
mod table;
mod tabled_gait;
#[cfg(test)]
mod testing;
mod travel;
mod units;
mod walker;
mod waveform;
mod yields;

pub use accuracy::TableError;
pub use audit::{Audit, Least, Peak};
pub use cells::CellMaps;
pub use checked_gait::{CheckedGait, Walked};
pub use coil::Coil;
pub use core_robot::{CoreRobot, flash};
pub use drive::{Drive, Kind};
pub use error::{Error, Hint, Problem};
pub use feet::{Body, Feet, GRAVITY};
pub use file::LONGEST;
pub use gait::Stride;
pub use ground::{DEFAULT_FRICTION, Ground};
pub use harmonic::Harmonic;
pub use legs::{LegPlace, LegPlan};
pub use parts::{Horn, Parts, Screw, ServoBody};
pub use path::Path;
pub use path_leg::PathLeg;
pub use place::Place;
pub use plate::Plate;
pub use report::{Report, Row, UNDECIDED};
pub use robot::Robot;
pub use sensitivity::{LEAVES, LONG, MOUNTS, PLAYS, RATIOS, Sensitive, Sensitivity, TWISTS};
pub use servo::{Pace, Servo};
pub use spring::Spring;
pub use sprung::Sprung;
pub use stance::Stance;
pub use strut::{SLOT, Strut};
pub use supply::{Rail, Supplies, healthy_rail_mv};
pub use syntax::mistake;
pub use travel::{Prediction, Travel};
pub use units::{FRAMES_PER_SECOND, STEPS_PER_DEGREE};
pub use walker::{Slip, Walker};
pub use waveform::Waveform;
