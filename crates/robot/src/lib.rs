//! Reads and checks robot.toml, the robot's configuration and gaits, for the host program, the page, the firmware's
//! build script and the tests.
//!
//! [`Robot::load`] reads the file and checks everything in it, including every sample of every gait, so every `Robot`
//! can walk. A `Robot` provides the gaits in floating point together with the firmware's tables ([`CheckedGait`]), the
//! robot in the core's integers ([`CoreRobot`]) and the section of flash that carries these to the board
//! ([`Robot::section`]).
//!
//! A file passes through the folders in this order: `file/` parses the text and reports errors in it, `config/` checks
//! the ranges of dimensions and parameters, `gaits/` computes the gaits in floating point, `tables/` rounds them to the
//! integers of the chip, `checks/` checks every sample, and `reports/` formats tables for people. `lizard-contact`
//! computes the movement over the floor; its types are exported here, too. Three modules serve programs that talk to a
//! board: `banner.rs` and `status.rs` parse its lines, and `calibration.rs` reads and transfers its settings.
//!
//! The whole file except its name, gaits and routines becomes a `RobotConfig`. The `RobotConfig`, the gaits' `Tables`
//! and the routines are converted to the integers of a section, [`lizard_core::numbers::section::Content`]. A [`Robot`]
//! holds all of these, and a [`CoreRobot`] is the core's view of the robot. docs/firmware.md lists the types of other
//! crates that also describe a robot.
//!
//! # When not to use it
//! For the geometry alone use `lizard-kinematics`, and for feet on a floor `lizard-contact`; neither needs a file. On a
//! microcontroller use `lizard-core`, because this crate needs `std` and floating point.

mod banner;
mod calibration;
mod checks;
mod config;
mod file;
mod gaits;
#[cfg(test)]
mod keys;
mod reports;
mod robot;
mod status;
mod tables;
#[cfg(test)]
mod testing;
mod units;

pub use banner::{Banner, RobotIdentity};
pub use calibration::{Calibration, ServoSettings, Transfer, round_to_hundredths};
pub use checks::{
    Audit, CheckedGait, Effort, HIGH_UTILISATION, MinMargin, PeakSpeed, SimulatedCycle, TableError,
};
pub use config::servo;
pub use config::{
    Coil, FUSE_RATING_A, Horn, INPUT_NAMES, Inputs, LegPlan, LegPoints, MIN_SWITCH_RATING_A, Pad,
    Parts, Plate, Rail, Screw, Servo, ServoBody, ServoType, SpeedLimits, Supplies,
    healthy_rail_pin_mv,
};
pub use file::{Error, MAX_FILE_BYTES, edit, explain_mistake};
pub use gaits::{Bars, Harmonic, Path, PathSweep, Routine, Stride, Waveform, to_command};
pub use lizard_contact::{
    Body, BodyPose, Contacts, DEFAULT_FRICTION, Drive, DriveKind, GRAVITY, GroundContact,
    JointFriction, LegGeometry, Motor, Motors, Prediction, SLOT_LENGTH, Stance, Strut, Travel,
    Walker,
};
pub use reports::violations;
pub use reports::{
    Assumptions, DisplacementRange, DriveEffect, Extreme, GaitRow, OPEN_INPUTS_NOTE, PACES_PERCENT,
    Report, RoutineRow, Sensitivity, ServoTable, UNDETERMINED_NOTE, plausible_range,
};
pub use robot::Robot;
pub use status::{Status, parse_pose_report};
pub use tables::{CellMaps, CoreRobot, keep_section};
pub use units::{FRAMES_PER_SECOND, STEPS_PER_DEGREE, STILL_FRAMES};
