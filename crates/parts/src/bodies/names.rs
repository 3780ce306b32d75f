//! The names of bodies.

use lizard_robot::servo::{LEG_NAMES, SERVO_NAMES};

/// Names of a servo and of its leg, such as A1 and LF.
pub fn servo_and_leg_names(servo: usize) -> (&'static str, &'static str) {
    (SERVO_NAMES[servo], LEG_NAMES[servo])
}

/// Name of the head's or tail's coupler on a servo's crank.
pub fn coupler_name(servo: usize) -> String {
    format!("coupler {}", servo_and_leg_names(servo).0)
}

/// Name of a leg's strut, slotted or rigid.
pub fn strut_name(is_slotted: bool, leg: &str) -> String {
    match is_slotted {
        true => format!("strut {leg}"),
        false => format!("rigid strut {leg}"),
    }
}
