//! The slotted strut between a servo's link and its leg: the strut's length, and the force of the spring in it.

use lizard_contact::{SLOT, Strut};

use crate::measures::coil::Coil;
use crate::measures::legs::LegPlan;
use crate::measures::parts::Parts;
use crate::measures::servo::ARM_SIDE;

/// The length, inside its hooks, of a spring mounted in a strut, mm: both hooks go around the far sides of their
/// screws.
pub(crate) fn mounted_spring_length(legs: &[LegPlan; 4], parts: &Parts) -> f64 {
    legs[0].strut_length + parts.screw.diameter
}

/// The strut of a robot with this spring in it. The servos' neutral angles are in deg, chassis frame.
pub(crate) fn strut_with_coil(
    legs: &[LegPlan; 4],
    neutral: [f64; 4],
    parts: &Parts,
    coil: &Coil,
) -> Strut {
    let [radius, angle] = parts.anchor;
    let arm_angle_of = |leg: usize| neutral[leg] - ARM_SIDE[leg] * angle - legs[leg].strut.angle();
    Strut {
        force: coil.force(mounted_spring_length(legs, parts)),
        rate: coil.rate(),
        slot: SLOT,
        length: legs[0].strut_length,
        radius,
        angles: std::array::from_fn(arm_angle_of),
    }
}
