//! The limits of a pose's margins.

use crate::numbers::units::Sine;

lizard_avr::plain! {
    /// The smallest margins allowed; a margin at its limit is safe.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Limits {
        /// The limit of the margin between the couplers of head and tail, at least a tenth.
        pub type2: Sine,
        /// The limit of the margin between each crank and its coupler, not negative.
        pub type1: Sine,
        /// The limit of the margin of each parallelogram leg, not negative.
        pub leg: Sine,
    }
}
