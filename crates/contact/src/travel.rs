//! The body's travel over the floor.

/// A displacement of the body over the floor, in the body's axes at its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// Distance forward, mm.
    pub forward: f64,
    /// Distance to the left, mm.
    pub left: f64,
    /// Turn, deg, counter-clockwise positive.
    pub turn: f64,
}
