//! The place of a body: its origin and its rotation about an upright axis.

use lizard_kinematics::{Real, Vector};

/// The position and rotation of a body's frame in the chassis frame, or in another body's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement<T = f64> {
    /// The frame's origin, mm.
    pub at: Vector<T>,
    /// The direction of the frame's x axis, a unit vector.
    pub turn: Vector<T>,
}

impl Placement {
    /// The chassis frame itself.
    pub const CHASSIS: Self = Self {
        at: Vector::new(0.0, 0.0),
        turn: Vector::new(1.0, 0.0),
    };

    /// Converts a point from the chassis frame to the body's frame, mm.
    pub fn unmap(&self, point: Vector) -> Vector {
        let from = point - self.at;
        Vector::new(from.dot(self.turn), self.turn.cross(from))
    }
}

impl<T: Real> Placement<T> {
    /// Converts a point from the body's frame to the chassis frame, mm.
    pub fn map(&self, point: Vector) -> Vector<T> {
        self.at + self.turn * point.x + self.turn.left() * point.y
    }

    /// Converts this placement to another body's frame. Both are given in the chassis frame.
    pub fn seen_from(&self, frame: &Self) -> Self {
        let in_frame = |v: Vector<T>| Vector::new(v.dot(frame.turn), frame.turn.cross(v));
        Self {
            at: in_frame(self.at - frame.at),
            turn: in_frame(self.turn),
        }
    }
}
