//! The firmware's integer guard compared with floating point at every pair of positions that two servos can take.
//!
//! Every condition of a safe pose depends on one servo (a leg), on the two servos of an end (head or tail) or on the
//! two servos of a side (left or right slider). It is therefore enough to try every pair of positions of each end and
//! each side, in the firmware's angle steps. This decides every possible pose: 1.2e18 poses for servos with a travel of
//! half a turn. Only a [`PairSample`] whose `one_in` is above 1 leaves out pairs.
//!
//! [`Proof::compute`] computes the whole proof. The pieces of a [`GuardComparison`] can also be computed on several
//! machines; [`Proof::from_tallies`] then combines their tallies. The crate reads, stores and prints nothing; a piece
//! uses all cores.
//!
//! # When not to use it
//! For a single pose: the guard itself (`lizard-core`) and the margins (`lizard-kinematics`) decide it at once. A guard
//! with conditions that depend on three or more servos needs another proof.
//!
//! # Units
//! mm and degrees, and the firmware's steps: 1/65536 turn for angles, and each robot's own step for lengths.

mod end_comparison;
mod guard_comparison;
mod positions;
mod proof;
mod rows;
mod side_comparison;
mod tally;

pub use guard_comparison::{GuardComparison, PIECE_COUNT};
pub use proof::Proof;
pub use rows::PairSample;
pub use tally::{Finding, LENGTH_BAND_STEPS, MARGIN_BAND, Tally, margin_band};
