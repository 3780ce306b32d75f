//! The four legs in servo order: the place of each, and the sense in which it turns.

/// The end of each leg in servo order: 1 for the front, -1 for the rear.
pub const FRONT: [f64; 4] = [1.0, 1.0, -1.0, -1.0];
/// The side of each leg, servo order: 1 on the left, -1 on the right.
pub const LEFT: [f64; 4] = [1.0, -1.0, -1.0, 1.0];
/// The sense in which each leg turns when its foot goes forward, counter-clockwise positive: a
/// leg on the left turns clockwise.
pub const FORWARD: [f64; 4] = [-LEFT[0], -LEFT[1], -LEFT[2], -LEFT[3]];
