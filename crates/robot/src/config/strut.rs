//! The slotted strut between a servo's link and its leg: the strut's length, and its spring's force.

use lizard_contact::{SLOT_LENGTH, Strut};

use crate::config::legs::LegPlan;
use crate::config::parts::Parts;
use crate::config::servo::ARM_TURN_SIGN;

/// The length of a spring mounted in a strut, measured between the insides of its hooks, mm. Each hook goes around the
/// far side of its screw, so a screw's diameter is added to the strut's length.
pub(crate) fn mounted_spring_length(legs: &[LegPlan; 4], parts: &Parts) -> f64 {
    legs[0].strut_length + parts.screw.diameter
}

/// Returns the strut of a robot with these legs and parts. The servos' neutral angles are in deg, chassis frame.
pub(crate) fn own_strut(legs: &[LegPlan; 4], neutral_angles: [f64; 4], parts: &Parts) -> Strut {
    let [radius, angle] = parts.anchor;
    let arm_angle = |leg: usize| {
        neutral_angles[leg] - ARM_TURN_SIGN[leg] * angle - legs[leg].strut_direction.angle()
    };
    Strut {
        preload: parts.spring.force(mounted_spring_length(legs, parts)),
        spring_rate: parts.spring.rate(),
        slot_length: SLOT_LENGTH,
        screw_distance: legs[0].strut_length,
        arm_length: radius,
        arm_angles: std::array::from_fn(arm_angle),
    }
}
