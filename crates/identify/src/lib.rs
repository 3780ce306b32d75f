//! Identifies a built robot: finds the robot.toml values with which the contact model moves like the robot.
//!
//! Some keys are assumptions until the robot stands on its floor: the play of its legs, the grain of its pads, a foot
//! that is too long, the centre of mass, the mounting of the legs. A video shows the robot's movement in a gait cycle.
//! Each key changes the gaits in different proportions, so several gaits together determine the keys. [`identify`]
//! estimates the keys in [`KEYS`] by weighted least squares, together with the position of the tag card on the deck
//! ([`CardPose`]), since a misplaced card would otherwise look like drift.
//!
//! A key that the movements do not determine keeps its value. A key whose standard error stays above half of its prior
//! standard deviation counts as undetermined ([`Verdict::Undetermined`]). A key that would change by less than two
//! standard errors counts as correct ([`Verdict::Unchanged`]). If the model deviates from the movements by more than
//! their errors, the errors of all keys are enlarged by the same factor ([`GoodnessOfFit`]).
//! [`Identification::updated_robot_toml`] writes the new robot.toml.
//!
//! The crate starts no threads, accesses no files and prints nothing.
//!
//! # When not to use it
//! The crate takes the servos' parameters from robot.toml: measure them first. Gaits recorded on different floors have
//! no common friction ratio.
//!
//! # Units
//! Lengths are in mm and angles in degrees; a movement is that of one cycle, in the robot's frame at the cycle's start.

mod card;
mod chi_square;
mod error;
mod identify;
mod key;
mod movement;
mod outcome;
mod problem;
mod robot_toml;

pub use card::CardPose;
pub use error::IdentifyError;
pub use identify::{Executor, identify};
pub use key::{KEYS, Key};
pub use movement::{COMPONENTS, MeasuredMovement};
pub use outcome::{GoodnessOfFit, Identification, KeyResult, MovementResult, Verdict};
