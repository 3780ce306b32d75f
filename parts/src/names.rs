//! What parts are called.

use lizard_robot::Strut;
use lizard_robot::servo::{LEGS, NAMES};

/// What a servo and its leg are called.
pub fn names(servo: usize) -> (&'static str, &'static str) {
    (NAMES[servo], LEGS[servo])
}

/// The name of the coupler on a servo's crank.
pub fn coupler(servo: usize) -> String {
    format!("coupler {}", names(servo).0)
}

/// The name of a leg's strut.
pub fn strut(strut: Strut, leg: &str) -> String {
    match strut {
        Strut::Spring => format!("strut {leg}"),
        Strut::Rigid => format!("rigid strut {leg}"),
    }
}
