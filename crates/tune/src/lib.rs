//! Searches for a gait that walks faster than a given gait at the same servo speed.
//!
//! Feet that are not lifted push against each other, so the speed of a gait is hard to predict. Therefore this crate
//! uses a search. A [`Tuning`] holds the given gait. A [`Search`] proposes parameters of one [`GaitKind`] and learns
//! from their scores. [`Tuning::score`] computes the speed that the gait exceeds on 95 % of some random robots and
//! floors ([`Variation`]). [`Tuning::build_best`] builds the best gait, and [`Tuning::compare`] simulates the best and
//! the given gait on robots that the search has not used.
//!
//! The crate starts no threads, accesses no files and prints nothing: `lizard tune` scores the trials of a round on all
//! cores, and the web page scores them sequentially in a worker. All random numbers come from one seed in a fixed
//! order, so both find the same gait.
//!
//! # When not to use it
//! The search varies four parameters of a wave gait or three parameters of a held gait. For a gait in which head or
//! tail follows a path, or which walks along a curve, write a table in robot.toml and check it with `lizard gaits`. For
//! another walking machine, use only the [`Search`] or an optimisation crate: the other types depend on a
//! `lizard_robot::Robot`.
//!
//! # Units
//! mm, degrees and seconds. Every array has the servo order A1, A2, A3, A4, which is the leg order left front, right
//! front, right hind, left hind.

mod comparison;
mod goal;
mod plan;
mod scorer;
mod search;
mod tuning;
mod variation;

pub use comparison::{Comparison, GaitPerformance};
pub use goal::Goal;
pub use plan::GaitKind;
pub use scorer::BuiltGait;
pub use search::{Search, trial_count};
pub use tuning::{Tuning, TuningError};
pub use variation::{
    FRICTION_FACTORS, PLAY_SPREAD_TEXT, SPREAD_TEXT, Variation, compute_quantiles,
};
