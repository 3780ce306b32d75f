//! The measured movement of a gait.

/// Names and units of the components of a movement, in the order of every array of components.
pub const COMPONENTS: [(&str, &str); 3] = [("ahead", "mm"), ("left", "mm"), ("turn", "deg")];

/// The robot's measured movement in one gait cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredMovement {
    /// The gait's name.
    pub gait: String,
    /// Pace as a fraction of the gait's nominal rate.
    pub pace: f64,
    /// Means over the cycles: forward (mm), left (mm), and turn (deg, counter-clockwise positive).
    pub mean: [f64; 3],
    /// Standard errors of the means, mm and deg.
    pub error: [f64; 3],
}
