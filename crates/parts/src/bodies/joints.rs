//! The joints from which the places of bodies follow, in any kind of number.

use lizard_kinematics::{End, FiveBarPose, Lizard, Real, Side, SliderPose, Solution, Vector};

/// The joints of the mechanism, computed on demand.
pub trait Joints<T> {
    /// Direction of a servo's crank, length one, chassis frame.
    fn crank(&self, servo: usize) -> Vector<T>;
    /// The five-bar of an end, in the end's own frame.
    fn end(&self, end: End) -> FiveBarPose<T>;
    /// The slider of a side.
    fn side(&self, side: Side) -> SliderPose<T>;
}

impl Joints<f64> for Solution {
    fn crank(&self, servo: usize) -> Vector {
        self.legs[servo].direction
    }

    fn end(&self, end: End) -> FiveBarPose {
        *Self::end(self, end)
    }

    fn side(&self, side: Side) -> SliderPose {
        *Self::side(self, side)
    }
}

/// Joints computed from the directions of some cranks. Those that depend on an unknown
/// crank are meaningless.
pub struct Cranks<'a, T> {
    /// The robot's dimensions.
    pub lizard: &'a Lizard,
    /// Directions of the cranks, length one, chassis frame, servo order.
    pub cranks: [Vector<T>; 4],
}

impl<T: Real> Joints<T> for Cranks<'_, T> {
    fn crank(&self, servo: usize) -> Vector<T> {
        self.cranks[servo]
    }

    fn end(&self, end: End) -> FiveBarPose<T> {
        self.lizard.shape_end(end, self.cranks)
    }

    fn side(&self, side: Side) -> SliderPose<T> {
        self.lizard.shape_side(side, self.cranks)
    }
}
