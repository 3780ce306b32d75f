//! Identification of a built robot: the keys of robot.toml with which the contact model goes as far as the robot did.
//!
//! Some keys are assumed until the robot stands on its floor: the play of its legs, the grain of its pads, a foot
//! that is too long, the mass centre, the mounting of the legs. A film tells how far the robot goes in a cycle of a gait, and
//! each of these keys changes the gaits in another proportion, so several gaits tell the keys.
//! [`identify`] finds them by weighted least squares ([`Key`] has the list), together with the place of the card with the tag on
//! the deck ([`Card`]), which would otherwise pass for a drift.
//!
//! What the ways do not tell is not changed. A key whose error stays above half of its doubt counts as unknown
//! ([`Verdict::Untold`]), one that would move by less than two errors as right ([`Verdict::Right`]). If the model leaves more of
//! the ways than their errors, the errors of all keys grow by as much ([`Goodness`]). [`Identified::text`] writes the new robot.toml.
//!
//! The crate starts no thread, and reads, stores and prints nothing.
//!
//! # When not to use it
//! Servos are taken as robot.toml has them: measure them first. A robot whose gaits were not filmed on one and the same
//! floor has no single ratio of friction.
//!
//! # Units
//! mm and degrees; ways are those of one cycle, seen from its beginning.

mod card;
mod chi_square;
mod identify;
mod key;
mod outcome;
mod problem;
mod text;
mod trouble;
mod way;

pub use card::Card;
pub use identify::{Each, identify};
pub use key::{KEYS, Key};
pub use outcome::{Found, Goodness, Identified, Row, Verdict};
pub use trouble::Trouble;
pub use way::{PARTS, Way};
