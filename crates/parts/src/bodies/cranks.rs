//! The directions of the cranks, and the five-bars and sliders that follow from them, for any number type.

use lizard_kinematics::{End, FiveBarPose, Lizard, Real, Side, SliderPose, Vector};

/// The directions of the cranks, which determine the placements of all bodies. Some directions may be placeholders; a
/// five-bar or slider that depends on a placeholder is meaningless.
pub struct Cranks<'a, T> {
    /// Dimensions of the linkage.
    pub lizard: &'a Lizard,
    /// Unit vectors along the cranks, chassis frame, servo order.
    pub directions: [Vector<T>; 4],
}

impl<T: Real> Cranks<'_, T> {
    /// Computes the pose of an end's five-bar, in the end's own frame.
    pub fn five_bar(&self, end: End) -> FiveBarPose<T> {
        self.lizard.end_pose_unchecked(end, self.directions)
    }

    /// Computes the pose of a side's slider.
    pub fn slider(&self, side: Side) -> SliderPose<T> {
        self.lizard.side_pose_unchecked(side, self.directions)
    }
}
