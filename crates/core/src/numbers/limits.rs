//! The limits that a pose must keep to.

use crate::numbers::units::Sine;

lizard_avr::plain! {
    /// The smallest margins allowed; a margin at its limit is safe.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Limits {
        /// The margin between the couplers of head and tail, at least a tenth.
        pub type2: Sine,
        /// The margin between each crank and its coupler, not negative.
        pub type1: Sine,
        /// The margin of each parallelogram leg, not negative.
        pub leg: Sine,
    }
}
