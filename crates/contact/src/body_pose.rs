//! The pose of the body on the floor: its position and its heading.

use crate::friction::Twist;
use crate::travel::Travel;

/// The pose of the body on the floor. The floor's axes are the body's axes at the start of the walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyPose {
    /// Distance forward, mm.
    pub forward: f64,
    /// Distance to the left, mm.
    pub left: f64,
    /// Heading, rad, counter-clockwise positive.
    pub heading: f64,
}

impl BodyPose {
    /// The start: the origin, with heading 0.
    pub const START: Self = Self {
        forward: 0.0,
        left: 0.0,
        heading: 0.0,
    };

    /// Returns the pose after the body has moved by this twist, at constant velocities in its own axes. The opposite
    /// twist leads back, except for rounding.
    pub(crate) fn moved_by_twist(self, [forward, left, turn]: Twist) -> Self {
        // The ratio of the chord's length to the arc's. The chord's direction is the heading at half the turn.
        let half_turn = turn / 2.0;
        let chord_over_arc = match half_turn {
            0.0 => 1.0,
            _ => half_turn.sin() / half_turn,
        };
        let (sin, cos) = (self.heading + half_turn).sin_cos();
        Self {
            forward: self.forward + chord_over_arc * (forward * cos - left * sin),
            left: self.left + chord_over_arc * (forward * sin + left * cos),
            heading: self.heading + turn,
        }
    }

    /// Returns the travel from an earlier pose to this one, in the body's axes at the earlier pose.
    pub fn travel_from(self, earlier: Self) -> Travel {
        let (sin, cos) = earlier.heading.sin_cos();
        let (x, y) = (self.forward - earlier.forward, self.left - earlier.left);
        Travel {
            forward: x * cos + y * sin,
            left: y * cos - x * sin,
            turn: (self.heading - earlier.heading).to_degrees(),
        }
    }

    /// Returns the pose after this travel: the inverse of [`BodyPose::travel_from`].
    pub fn moved_by_travel(self, travel: Travel) -> Self {
        let [forward, left] = self.to_floor([travel.forward, travel.left]);
        Self {
            forward,
            left,
            heading: self.heading + travel.turn.to_radians(),
        }
    }

    /// Converts a point from the body's axes to the floor's axes; both are (forward, left), mm.
    pub fn to_floor(self, [forward, left]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.heading.sin_cos();
        [
            self.forward + forward * cos - left * sin,
            self.left + forward * sin + left * cos,
        ]
    }

    /// Returns the travel from the start to this pose.
    pub fn travel(self) -> Travel {
        self.travel_from(Self::START)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assert_near;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn assert_at(pose: BodyPose, [forward, left, turn]: [f64; 3]) {
        let travel = pose.travel();
        assert_near(travel.forward, forward, 1e-12);
        assert_near(travel.left, left, 1e-12);
        assert_near(travel.turn, turn, 1e-12);
    }

    #[test]
    fn a_twist_moves_the_body_along_its_own_axes() {
        let turned_pose = BodyPose::START.moved_by_twist([0.0, 0.0, FRAC_PI_2]);
        for (start, twist, expected) in [
            (BodyPose::START, [10.0, 0.0, 0.0], [10.0, 0.0, 0.0]),
            (BodyPose::START, [0.0, 10.0, 0.0], [0.0, 10.0, 0.0]),
            // After a quarter turn to the left, the body's forward axis points left and its left axis back.
            (turned_pose, [10.0, 0.0, 0.0], [0.0, 10.0, 90.0]),
            (turned_pose, [0.0, 10.0, 0.0], [-10.0, 0.0, 90.0]),
        ] {
            assert_at(start.moved_by_twist(twist), expected);
        }
    }

    #[test]
    fn a_body_that_turns_as_it_moves_follows_a_circle() {
        // A quarter circle and a semicircle, both to the left, of radius 10.
        for (turn, expected) in [(FRAC_PI_2, [10.0, 10.0, 90.0]), (PI, [0.0, 20.0, 180.0])] {
            let pose = BodyPose::START.moved_by_twist([10.0 * turn, 0.0, turn]);
            assert_at(pose, expected);
        }
    }

    #[test]
    fn the_travel_of_a_twist_does_not_depend_on_the_start_pose() {
        let start = BodyPose::START.moved_by_twist([3.0, 4.0, FRAC_PI_2]);
        let twist = [10.0, -2.0, 0.3];
        let end = start.moved_by_twist(twist);
        let travel = end.travel_from(start);
        let expected = BodyPose::START.moved_by_twist(twist).travel();
        let expected = [expected.forward, expected.left, expected.turn];
        assert_at(BodyPose::START.moved_by_travel(travel), expected);
        let error = start.moved_by_travel(travel).travel_from(end);
        assert_near(error.forward, 0.0, 1e-12);
        assert_near(error.left.hypot(error.turn), 0.0, 1e-12);
    }

    #[test]
    fn a_point_is_converted_from_the_bodys_axes_to_the_floors_axes() {
        let pose = BodyPose {
            forward: 1.0,
            left: 2.0,
            heading: FRAC_PI_2,
        };
        let [forward, left] = pose.to_floor([10.0, 3.0]);
        assert_near(forward, -2.0, 1e-12);
        assert_near(left, 12.0, 1e-12);
    }
}
