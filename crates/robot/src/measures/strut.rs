//! The slotted strut between a servo's link and its leg: the strut's length, and the force of the spring in it.

use lizard_contact::{SLOT_LENGTH, Strut};

use crate::measures::coil::Coil;
use crate::measures::legs::LegPlan;
use crate::measures::parts::Parts;
use crate::measures::servo::ARM_SIDE;

/// The length between the insides of the hooks of a spring mounted in a strut, mm. Each hook goes around the far side
/// of its screw, so a screw's diameter is added to the strut's length.
pub(crate) fn mounted_spring_length(legs: &[LegPlan; 4], parts: &Parts) -> f64 {
    legs[0].strut_length + parts.screw.diameter
}

/// The strut of a robot with this spring in it. The neutral angles of the servos are in deg, chassis frame.
pub(crate) fn strut_with_coil(
    legs: &[LegPlan; 4],
    neutral_angles: [f64; 4],
    parts: &Parts,
    coil: &Coil,
) -> Strut {
    let [radius, angle] = parts.anchor;
    let arm_angle_of = |leg: usize| {
        neutral_angles[leg] - ARM_SIDE[leg] * angle - legs[leg].strut_direction.angle()
    };
    Strut {
        force: coil.force(mounted_spring_length(legs, parts)),
        rate: coil.rate(),
        slot_length: SLOT_LENGTH,
        length: legs[0].strut_length,
        arm_length: radius,
        arm_angles: std::array::from_fn(arm_angle_of),
    }
}
