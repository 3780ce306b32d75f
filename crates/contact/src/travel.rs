//! How far the robot gets on its floor, and how much of that is known in advance.

/// Where the robot got to, seen from where it started.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// mm.
    pub forward: f64,
    /// mm.
    pub left: f64,
    /// deg, counter-clockwise.
    pub turn: f64,
}

/// What is known of a way in advance, seen from where it started. None is what
/// depends on a tie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// mm.
    pub forward: Option<f64>,
    /// mm.
    pub left: Option<f64>,
    /// deg, counter-clockwise.
    pub turn: Option<f64>,
}

impl Prediction {
    /// True if nothing depends on a tie.
    pub fn is_decided(&self) -> bool {
        self.forward.is_some() && self.left.is_some() && self.turn.is_some()
    }

    /// Another way over the same ties: as much of it is known as of this one.
    #[must_use]
    pub fn known_of(&self, travel: Travel) -> Self {
        Self {
            forward: self.forward.and(Some(travel.forward)),
            left: self.left.and(Some(travel.left)),
            turn: self.turn.and(Some(travel.turn)),
        }
    }
}
