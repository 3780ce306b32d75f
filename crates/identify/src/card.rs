//! The pose of the tag card on the robot's deck.
//!
//! With a rotated card, part of the forward movement looks like drift. A card away from the robot's centre moves on an
//! arc when the robot turns. Both effects would look like an error of the centre of mass or of a foot.

use lizard_robot::{BodyPose, Travel};

/// The card's position and direction on the robot, relative to the chassis centre and the forward direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CardPose {
    /// Rotation from the robot's forward direction, deg, counter-clockwise.
    pub turn: f64,
    /// Distance of the card's centre in front of the chassis centre, mm.
    pub forward: f64,
    /// Distance of the card's centre to the left of the chassis centre, mm.
    pub left: f64,
}

/// Number of card parameters.
pub(crate) const PARAMETER_COUNT: usize = 3;

impl CardPose {
    /// Standard deviations of the mounting errors of hand-glued cards: turn (deg), forward (mm) and left (mm).
    pub(crate) const PRIOR_ERRORS: [f64; PARAMETER_COUNT] = [2.0, 2.0, 2.0];

    /// Converts the robot's movement to the card's movement, in the card's frame at the start: forward, left, turn.
    pub(crate) fn convert_travel(&self, robot_travel: Travel) -> [f64; 3] {
        let to_card = Travel {
            forward: self.forward,
            left: self.left,
            turn: self.turn,
        };
        let robot_end = BodyPose::START.moved_by_travel(robot_travel);
        let card_start = BodyPose::START.moved_by_travel(to_card);
        let card_travel = robot_end.moved_by_travel(to_card).travel_from(card_start);
        [card_travel.forward, card_travel.left, card_travel.turn]
    }
}

impl From<[f64; PARAMETER_COUNT]> for CardPose {
    fn from([turn, forward, left]: [f64; PARAMETER_COUNT]) -> Self {
        Self {
            turn,
            forward,
            left,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_card_travel(
        card: [f64; PARAMETER_COUNT],
        robot_travel: [f64; 3],
        expected_travel: [f64; 3],
    ) {
        let [forward, left, turn] = robot_travel;
        let travel = CardPose::from(card).convert_travel(Travel {
            forward,
            left,
            turn,
        });
        for (actual, expected) in travel.into_iter().zip(expected_travel) {
            assert!(
                (actual - expected).abs() < 1e-9,
                "{card:?}: expected {expected}, got {actual}"
            );
        }
    }

    #[test]
    fn a_card_at_its_nominal_position_moves_like_the_robot() {
        assert_card_travel([0.0; 3], [30.0, 2.0, 15.0], [30.0, 2.0, 15.0]);
    }

    #[test]
    fn a_card_rotated_to_the_left_measures_a_drift_to_the_right() {
        let (sin, cos) = 30f64.to_radians().sin_cos();
        let expected_travel = [10.0 * cos, -10.0 * sin, 0.0];
        assert_card_travel([30.0, 4.0, 5.0], [10.0, 0.0, 0.0], expected_travel);
    }

    #[test]
    fn a_card_in_front_of_the_chassis_centre_moves_around_it() {
        // A quarter turn about the chassis centre moves the card from 10 mm in front of it to 10 mm to its left.
        assert_card_travel([0.0, 10.0, 0.0], [0.0, 0.0, 90.0], [-10.0, 10.0, 90.0]);
    }
}
