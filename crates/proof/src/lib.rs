//! The firmware's integer guard compared with floating point at every pair of positions that two servos can take.
//!
//! Every condition of a safe pose depends on one servo (a leg), on the two servos of an end or on the two of a side.
//! So trying every pair of each end and of each side, in the steps in which the firmware counts angles, decides every
//! possible pose: 1.8e18 for servos with a travel of half a turn. Nothing is sampled, unless a [`PairSample`] says so.
//!
//! [`Proof::of`] computes all of it. The pieces of a [`Walk`] can be computed on several machines, and their tallies
//! put together by [`Proof::from_tallies`]. The crate reads, stores and prints nothing; a piece uses all cores.
//!
//! # When not to use it
//! For one pose: the guard itself (`lizard-core`) and the margins (`lizard-kinematics`) decide that at once. A guard
//! whose conditions depend on three servos or more needs another proof.
//!
//! # Units
//! mm and degrees, and the firmware's steps: 1/65536 turn, and the step of the lengths of a robot.

mod end_walk;
mod positions;
mod proof;
mod rows;
mod side_walk;
mod tally;
mod walk;

pub use proof::Proof;
pub use rows::PairSample;
pub use tally::{Finding, MARGIN_BAND, STEPS_BAND, Tally, margin_band};
pub use walk::{PIECES, Walk};
