//! The signs of the four legs in servo order: front or hind, left or right, and the sense of rotation.

/// The end of each leg, servo order: 1 for the front legs, -1 for the hind legs.
pub const FRONT_SIGN: [f64; 4] = [1.0, 1.0, -1.0, -1.0];
/// The side of each leg, servo order: 1 for the left, -1 for the right.
pub const LEFT_SIGN: [f64; 4] = [1.0, -1.0, -1.0, 1.0];
/// The sense of rotation in which each leg moves its foot forward: 1 for counter-clockwise (right legs), -1 for
/// clockwise (left legs).
pub const FORWARD_TURN_SIGN: [f64; 4] =
    [-LEFT_SIGN[0], -LEFT_SIGN[1], -LEFT_SIGN[2], -LEFT_SIGN[3]];
