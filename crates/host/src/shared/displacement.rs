//! A displacement of the robot in JSON output.

use lizard_robot::Prediction;
use serde::Serialize;

/// A displacement of the body. A component is null if the contact model cannot determine it because two feet balance
/// the other two (a tie).
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Displacement {
    /// Distance forward, mm.
    pub forward: Option<f64>,
    /// Distance to the left, mm.
    pub left: Option<f64>,
    /// Turn, deg counter-clockwise.
    pub turn: Option<f64>,
}

impl From<Prediction> for Displacement {
    fn from(prediction: Prediction) -> Self {
        Self {
            forward: prediction.forward,
            left: prediction.left,
            turn: prediction.turn,
        }
    }
}
