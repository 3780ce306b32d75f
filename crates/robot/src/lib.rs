//! A reader and checker of robot.toml, the robot's measurements and gaits, for the host program,
//! the page, the firmware's build script and the tests.
//!
//! [`Robot::load`] reads the file and checks everything in it, including every sample of
//! every gait, so every `Robot` can walk. It provides the gaits in floating point together
//! with the tables that the firmware reads ([`CheckedGait`]), the robot in the integers
//! of the core ([`CoreRobot`]) and the section of flash that carries these to the board
//! ([`Robot::section`]).
//!
//! A file passes through the folders in this order: `file/` parses the text and reports errors in it,
//! `measures/` checks the ranges of the measurements, `gaits/` computes the gaits in floating point, `tables/`
//! rounds them to the integers of the chip, `checks/` checks every sample, and `reports/` formats tables for people.
//! `lizard-contact` computes the movement over the floor; its types are exported here, too.
//!
//! All of the file except its gaits becomes `Measures`. The `Measures` and the gaits' `Tables` become the
//! integers, [`lizard_core::numbers::section::Content`]. A [`Robot`] holds all three, and a
//! [`CoreRobot`] is the core's view of the robot. docs/firmware.md lists the types of other crates
//! that also describe a robot.
//!
//! # When not to use it
//! For the geometry alone use `lizard-kinematics`, and for feet on a floor `lizard-contact`:
//! neither needs a file. On a microcontroller use `lizard-core`: this crate needs `std` and
//! floating point.

mod banner;
mod calibration;
mod checks;
mod file;
mod gaits;
#[cfg(test)]
mod keys;
mod measures;
mod reports;
mod robot;
mod status;
mod tables;
#[cfg(test)]
mod testing;
mod units;

pub use banner::{Banner, RobotIdentity};
pub use calibration::{Calibration, ServoSettings, Transfer};
pub use checks::{
    Audit, CheckedGait, Effort, HIGH_LINE_SHARE, LeastMargin, PeakSpeed, SimulatedCycle, TableError,
};
pub use file::{Error, MAX_FILE_BYTES, edit, explain_mistake};
pub use gaits::{Bars, Harmonic, Path, PathLeg, Routine, Stride, Waveform, command_of};
pub use lizard_contact::{
    Body, DEFAULT_FRICTION, Drive, DriveKind, Feet, GRAVITY, Ground, JointFriction, Motor, Motors,
    Place, Prediction, SLOT_LENGTH, Slip, Stance, Strut, Travel, Walker,
};
pub use measures::servo;
pub use measures::{
    Coil, FUSE_RATING_A, Horn, INPUT_NAMES, Inputs, LegPlace, LegPlan, MIN_SWITCH_RATING_A, Pad,
    Parts, Plate, Rail, Screw, Servo, ServoBody, ServoType, SpeedLimits, Supplies, healthy_rail_mv,
};
pub use reports::verdict;
pub use reports::{
    Assumptions, Extreme, MovementRange, PACES_PERCENT, Report, Round, Row, Sensitivity,
    ServoTable, SpringCost, UNDECIDED_NOTE, WITHOUT_CONTACTS_NOTE, plausible_range,
};
pub use robot::Robot;
pub use status::{Status, parse_pose_report};
pub use tables::{CellMaps, CoreRobot, flash};
pub use units::{FRAMES_PER_SECOND, STEPS_PER_DEGREE, STILL_FRAMES};
