//! The directions of the cranks, and the five-bars and sliders that follow from them, for any number type.

use lizard_kinematics::{End, FiveBarPose, Lizard, Real, Side, SliderPose, Solution, Vector};

/// The directions of the cranks, which determine the placements of all bodies. Some directions may be unknown; a
/// five-bar or slider that depends on an unknown direction is meaningless.
pub struct Cranks<'a, T> {
    /// The robot's dimensions.
    pub lizard: &'a Lizard,
    /// Directions of the cranks, length one, chassis frame, servo order.
    pub directions: [Vector<T>; 4],
}

impl<'a> Cranks<'a, f64> {
    /// The cranks of a pose.
    pub fn of(lizard: &'a Lizard, pose: &Solution) -> Self {
        let directions = pose.legs.map(|leg| leg.direction);
        Self { lizard, directions }
    }
}

impl<T: Real> Cranks<'_, T> {
    /// The five-bar of an end, in the end's own frame.
    pub fn five_bar(&self, end: End) -> FiveBarPose<T> {
        self.lizard.end_pose_unchecked(end, self.directions)
    }

    /// The slider of a side.
    pub fn slider(&self, side: Side) -> SliderPose<T> {
        self.lizard.side_pose_unchecked(side, self.directions)
    }
}
