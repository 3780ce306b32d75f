//! Search for a gait that walks faster although its servos turn no faster.
//!
//! Feet that are not lifted push against each other, so it is hard to predict which of two similar gaits walks
//! farther. This crate searches instead. A [`Tuning`] holds the given gait. A [`Search`] proposes parameters of one
//! [`Kind`] of gait and learns from their scores. [`Tuning::score`] is the speed that nearly all of some random
//! robots and floors exceed ([`Variation`]). [`Tuning::best`] builds the best gait, and [`Tuning::compare`] walks
//! it and the given one on robots that the search has not used.
//!
//! The crate starts no thread, and reads, stores and prints nothing: `lizard tune` scores the trials of a round on
//! all cores, the page one after another in a worker. All random numbers come from one seed in a fixed order, so
//! both find the same gait.
//!
//! # When not to use it
//! The search varies four parameters of a wave or three of a held gait. For a gait along a path of head or tail, or
//! along a curve, write a table in robot.toml and let `lizard gaits` check it. For another walking machine, use
//! only the [`Search`], or a crate for optimisation: the rest depends on a `lizard_robot::Robot`.
//!
//! # Units
//! mm, degrees and seconds. Servo order A1, A2, A3, A4 in every array, which is legs LF, RF,
//! RH, LH.

mod comparison;
mod goal;
mod judge;
mod plan;
mod search;
mod tuning;
mod variation;

pub use comparison::{Comparison, Figures};
pub use goal::Goal;
pub use judge::BuiltGait;
pub use plan::Kind;
pub use search::{Search, trials};
pub use tuning::{ScoredParameters, Tuning, TuningError};
pub use variation::{FRICTION, PLAY_SPREAD, SPREAD, Variation, quantiles};
