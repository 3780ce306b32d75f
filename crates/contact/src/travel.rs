//! The movement of the body over the floor, and its prediction.

/// The movement of the body, seen from its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// Distance ahead, mm.
    pub forward: f64,
    /// Distance to the left, mm.
    pub left: f64,
    /// Turn, deg, counter-clockwise positive.
    pub turn: f64,
}

/// A predicted movement; a part that depends on a tie is `None`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// Distance ahead, mm.
    pub forward: Option<f64>,
    /// Distance to the left, mm.
    pub left: Option<f64>,
    /// Turn, deg, counter-clockwise positive.
    pub turn: Option<f64>,
}

impl Prediction {
    /// True if no part depends on a tie.
    pub fn is_decided(&self) -> bool {
        self.forward.is_some() && self.left.is_some() && self.turn.is_some()
    }

    /// Keeps the parts of a movement that are known in this prediction.
    pub fn keep_known(&self, travel: Travel) -> Self {
        Self {
            forward: self.forward.and(Some(travel.forward)),
            left: self.left.and(Some(travel.left)),
            turn: self.turn.and(Some(travel.turn)),
        }
    }
}
