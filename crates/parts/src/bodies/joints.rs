//! The joints that determine the placements of the bodies, for any number type.

use lizard_kinematics::{End, FiveBarPose, Lizard, Real, Side, SliderPose, Solution, Vector};

/// The directions of the cranks, from which the joints are computed. Some directions may be unknown; joints that
/// depend on an unknown direction are meaningless.
pub struct Cranks<'a, T> {
    /// The robot's dimensions.
    pub lizard: &'a Lizard,
    /// Directions of the cranks, length one, chassis frame, servo order.
    pub cranks: [Vector<T>; 4],
}

impl<'a> Cranks<'a, f64> {
    /// The cranks of a pose.
    pub fn of(lizard: &'a Lizard, pose: &Solution) -> Self {
        let cranks = pose.legs.map(|leg| leg.direction);
        Self { lizard, cranks }
    }
}

impl<T: Real> Cranks<'_, T> {
    /// The five-bar of an end, in the end's own frame.
    pub fn end(&self, end: End) -> FiveBarPose<T> {
        self.lizard.shape_end(end, self.cranks)
    }

    /// The slider of a side.
    pub fn side(&self, side: Side) -> SliderPose<T> {
        self.lizard.shape_side(side, self.cranks)
    }
}
