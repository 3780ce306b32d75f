//! A displacement of the robot in JSON output.

use lizard_robot::{Prediction, Travel};
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

impl Displacement {
    /// Returns the components of `travel` that are determined; the components are forward, left and turn.
    pub fn from_travel(travel: Travel, are_determined: [bool; 3]) -> Self {
        let [has_forward, has_left, has_turn] = are_determined;
        Self {
            forward: has_forward.then_some(travel.forward),
            left: has_left.then_some(travel.left),
            turn: has_turn.then_some(travel.turn),
        }
    }

    /// Returns the components: forward, left and turn.
    pub fn components(&self) -> [Option<f64>; 3] {
        [self.forward, self.left, self.turn]
    }

    /// Returns true for each determined component: forward, left and turn.
    pub fn are_determined(&self) -> [bool; 3] {
        self.components().map(|component| component.is_some())
    }
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
