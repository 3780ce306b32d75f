//! Where a body is: its origin, and how far it is turned about an upright axis.

use lizard_kinematics::Vector;

/// The place of a body's own frame in the chassis frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The frame's origin, mm.
    pub at: Vector,
    /// The direction of its x axis, length one.
    pub turn: Vector,
}

impl Place {
    /// The chassis frame itself.
    pub const CHASSIS: Self = Self {
        at: Vector::new(0.0, 0.0),
        turn: Vector::new(1.0, 0.0),
    };

    /// A point of the body's frame in the chassis frame.
    #[must_use]
    pub fn map(&self, point: Vector) -> Vector {
        self.at + self.turn * point.x + self.turn.left() * point.y
    }

    /// A point of the chassis frame in the body's frame.
    #[must_use]
    pub fn unmap(&self, point: Vector) -> Vector {
        let from = point - self.at;
        Vector::new(from.dot(self.turn), self.turn.cross(from))
    }
}
