//! The signs of the four legs in servo order: front or hind, left or right, and the sense of rotation.

/// The end of each leg in servo order: 1 for the front, -1 for the hind legs.
pub const FRONT_SIGN: [f64; 4] = [1.0, 1.0, -1.0, -1.0];
/// The side of each leg, servo order: 1 on the left, -1 on the right.
pub const LEFT_SIGN: [f64; 4] = [1.0, -1.0, -1.0, 1.0];
/// The sense in which each leg turns when its foot moves forward: 1 for counter-clockwise (the legs
/// on the right), -1 for clockwise (the legs on the left).
pub const FORWARD_TURN_SIGN: [f64; 4] =
    [-LEFT_SIGN[0], -LEFT_SIGN[1], -LEFT_SIGN[2], -LEFT_SIGN[3]];
