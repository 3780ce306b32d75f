//! Search for a gait that walks faster than a given gait without faster servos.
//!
//! Feet that are not lifted push against each other, so it is hard to predict which of two similar gaits is faster.
//! This crate searches instead. A [`Tuning`] holds the given gait. A [`Search`] proposes parameters of one
//! [`GaitKind`] and learns from their scores. [`Tuning::score`] is the speed that the gait exceeds on 95 % of a number
//! of random robots and floors ([`Variation`]). [`Tuning::build_best`] builds the best gait, and [`Tuning::compare`]
//! simulates the best and the given gait on robots that the search has not used.
//!
//! The crate starts no thread, and reads, stores and prints nothing: `lizard tune` scores the trials of a round on
//! all cores, and the web page scores them one after another in a worker. All random numbers come from one seed in a
//! fixed order, so both find the same gait.
//!
//! # When not to use it
//! The search varies four parameters of a wave gait or three parameters of a held gait. For a gait that follows a path
//! of the head or tail, or that walks along a curve, write a table in robot.toml and let `lizard gaits` check it. For
//! another walking machine, use only the [`Search`] or an optimisation crate: the other types depend on a
//! `lizard_robot::Robot`.
//!
//! # Units
//! mm, degrees and seconds. Servo order A1, A2, A3, A4 in every array, which is legs LF, RF, RH, LH.

mod comparison;
mod goal;
mod judge;
mod plan;
mod search;
mod tuning;
mod variation;

pub use comparison::{Comparison, GaitFigures};
pub use goal::Goal;
pub use judge::BuiltGait;
pub use plan::GaitKind;
pub use search::{Search, trial_count};
pub use tuning::{ScoredParameters, Tuning, TuningError};
pub use variation::{FRICTION_FACTORS, PLAY_SPREAD_TEXT, SPREAD_TEXT, Variation, quantiles};
