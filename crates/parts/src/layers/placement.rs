//! The placement of a body: its origin and its rotation about a vertical axis.

use lizard_kinematics::{Real, Vector};

/// Position and rotation of a body's frame in an outer frame: the chassis frame or another body's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement<T = f64> {
    /// Origin of the frame, mm.
    pub origin: Vector<T>,
    /// Unit vector along the frame's x axis.
    pub x_axis: Vector<T>,
}

impl<T> Placement<T> {
    /// Creates a placement from the frame's origin and the unit vector along its x axis.
    pub const fn new(origin: Vector<T>, x_axis: Vector<T>) -> Self {
        Self { origin, x_axis }
    }
}

impl Placement {
    /// The chassis frame itself.
    pub const CHASSIS: Self = Self::new(Vector::new(0.0, 0.0), Vector::new(1.0, 0.0));

    /// Converts a point from this placement's outer frame to the body's frame, mm.
    pub fn unmap(&self, point: Vector) -> Vector {
        let offset = point - self.origin;
        Vector::new(offset.dot(self.x_axis), self.x_axis.cross(offset))
    }
}

impl<T: Real> Placement<T> {
    /// Converts a point from the body's frame to this placement's outer frame, mm.
    pub fn map(&self, point: Vector) -> Vector<T> {
        self.origin + self.x_axis * point.x + self.x_axis.rotated_left() * point.y
    }

    /// Converts this placement to another body's frame. Both placements are given in the chassis frame.
    pub fn relative_to(&self, frame: &Self) -> Self {
        let to_frame = |v: Vector<T>| Vector::new(v.dot(frame.x_axis), frame.x_axis.cross(v));
        Self::new(to_frame(self.origin - frame.origin), to_frame(self.x_axis))
    }
}
