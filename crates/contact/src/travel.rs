//! The body's travel over the floor, and its prediction.

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

/// A predicted travel. A component is `None` if friction does not determine it: if two feet pull one way and two the
/// other way, the slightest difference between the pads decides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// Distance forward, mm.
    pub forward: Option<f64>,
    /// Distance to the left, mm.
    pub left: Option<f64>,
    /// Turn, deg, counter-clockwise positive.
    pub turn: Option<f64>,
}

impl Prediction {
    /// True if friction determines all three components.
    pub fn is_determined(&self) -> bool {
        self.forward.is_some() && self.left.is_some() && self.turn.is_some()
    }

    /// Returns the components of `travel` that this prediction determines.
    pub fn keep_determined(&self, travel: Travel) -> Self {
        Self {
            forward: self.forward.and(Some(travel.forward)),
            left: self.left.and(Some(travel.left)),
            turn: self.turn.and(Some(travel.turn)),
        }
    }
}
