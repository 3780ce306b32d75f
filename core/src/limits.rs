//! What a pose must keep clear of.

use crate::units::Sine;

/// The smallest margins allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Between the couplers of head and tail.
    pub type2: Sine,
    /// Between each crank and its coupler.
    pub type1: Sine,
    /// Of each parallelogram leg.
    pub leg: Sine,
}
