//! The names of bodies.

use lizard_robot::servo::{LEGS, NAMES};

/// The names of a servo and of its leg, such as A1 and LF.
pub fn names(servo: usize) -> (&'static str, &'static str) {
    (NAMES[servo], LEGS[servo])
}

/// The name of the head's or tail's coupler on a servo's crank.
pub fn coupler(servo: usize) -> String {
    format!("coupler {}", names(servo).0)
}

/// The name of a leg's strut, which is either slotted or rigid.
pub fn strut(is_slotted: bool, leg: &str) -> String {
    match is_slotted {
        true => format!("strut {leg}"),
        false => format!("rigid strut {leg}"),
    }
}
