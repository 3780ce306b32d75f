//! The limits of a pose's margins to its singularities.

use crate::numbers::units::Sine;

lizard_avr::pod! {
    /// The smallest allowed margin of each kind.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Limits {
        /// The limit of the type-2 margins, each between the two couplers of an end; at least a tenth.
        pub type2: Sine,
        /// The limit of the type-1 margins, each between a crank and its coupler; not negative.
        pub type1: Sine,
        /// The limit of the margins of the parallelogram legs; not negative.
        pub leg: Sine,
    }
}
