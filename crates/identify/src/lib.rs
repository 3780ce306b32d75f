//! Identification of a built robot: finds the values of robot.toml with which the contact model moves like the robot.
//!
//! Some keys are assumptions until the robot stands on its floor: the play of its legs, the grain of its pads, a foot
//! that is too long, the mass centre, the mounting of the legs. A film shows how far the robot moves in a cycle of a
//! gait. Each key changes the gaits in different proportions, so several gaits together determine the keys.
//! [`identify`] finds the keys that [`KEYS`] lists by weighted least squares, together with the place of the card with
//! the tag on the deck ([`Card`]); an error of that place would otherwise look like drift.
//!
//! A key that the movements do not determine keeps its value. A key whose standard error stays above half of its prior
//! standard deviation counts as undetermined ([`Verdict::Undetermined`]). A key that would change by less than two
//! standard errors counts as correct ([`Verdict::Unchanged`]). If the model deviates from the movements by more than
//! their errors, the errors of all keys grow in proportion ([`GoodnessOfFit`]). [`Identified::updated_robot_toml`]
//! writes the new robot.toml.
//!
//! The crate starts no thread, and reads, stores and prints nothing.
//!
//! # When not to use it
//! The servos are taken from robot.toml: measure them first. Gaits that were filmed on different floors have no
//! single friction ratio.
//!
//! # Units
//! mm and degrees; movements are those of one cycle, in the robot's frame at the start of the cycle.

mod card;
mod chi_square;
mod error;
mod identify;
mod key;
mod movement;
mod outcome;
mod problem;
mod text;

pub use card::Card;
pub use error::IdentifyError;
pub use identify::{RunAll, identify};
pub use key::{KEYS, Key};
pub use movement::{COMPONENTS, MeasuredMovement};
pub use outcome::{GoodnessOfFit, Identified, KeyResult, MovementResult, Verdict};
