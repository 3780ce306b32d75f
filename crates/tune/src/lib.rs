//! A gait that walks faster, by servos that turn no faster.
//!
//! Legs whose feet are not lifted push against each other, so which of two similar gaits walks
//! farther is hard to foresee. This crate searches: a [`Tuning`] is the gait that is to be
//! surpassed, a [`Search`] proposes parameters of one [`Kind`] of gait and learns from their
//! scores, and [`Tuning::score`] is how fast the gait of such parameters walks on nearly all of a
//! few random robots and floors ([`Variation`]). [`Tuning::best`] is the gait that was found,
//! and [`Tuning::compare`] walks it beside the one of before on robots that the search has not
//! seen.
//!
//! The crate starts no thread, and reads, stores and prints nothing: `lizard tune` scores the
//! trials of a round on all cores, the page one after the other in a worker. All random
//! numbers come from one seed and in one order, so both find the same gait.
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
pub use judge::Built;
pub use plan::Kind;
pub use search::{Search, trials};
pub use tuning::{NoTuning, Scored, Tuning};
pub use variation::{PLAYED, SPREAD, Variation, quantiles};
