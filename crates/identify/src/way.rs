//! The measured movement of a gait.

/// Names and units of the parts of a movement, in the order of every array of parts.
pub const PARTS: [(&str, &str); 3] = [("ahead", "mm"), ("left", "mm"), ("turn", "deg")];

/// Measured movement of the robot in one cycle of a gait.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredMovement {
    /// Name of the gait.
    pub gait: String,
    /// Pace relative to the gait's own, which is 1.
    pub pace: f64,
    /// Mean of the cycles: distance ahead and to the left, mm, and turn counter-clockwise, deg.
    pub mean: [f64; 3],
    /// Standard errors of the means.
    pub error: [f64; 3],
}
