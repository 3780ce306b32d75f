//! A measured way.

/// The parts of a way and their units, in the order of every array of them.
pub const PARTS: [(&str, &str); 3] = [("ahead", "mm"), ("left", "mm"), ("turn", "deg")];

/// The way of the robot in a cycle of a gait, as it was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// Name of the gait.
    pub gait: String,
    /// Pace of the gait; 1 is its own.
    pub pace: f64,
    /// Way ahead and to the left, mm, and turn counter-clockwise, deg: the mean of the cycles.
    pub mean: [f64; 3],
    /// Standard errors of the means.
    pub error: [f64; 3],
}
