//! The measured movement of a gait.

/// Names and units of the components of a movement, in the order of every array of components.
pub const COMPONENTS: [(&str, &str); 3] = [("ahead", "mm"), ("left", "mm"), ("turn", "deg")];

/// Movement of the robot in one cycle of a gait, as measured.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredMovement {
    /// Name of the gait.
    pub gait: String,
    /// Pace relative to the gait's own, which is 1.
    pub pace: f64,
    /// Mean of the cycles: forward and left, mm, and turn, deg, counter-clockwise positive.
    pub mean: [f64; 3],
    /// Standard errors of the means, mm and deg.
    pub error: [f64; 3],
}
