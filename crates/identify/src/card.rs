//! The mounting error of the card with the tag on the robot's deck.
//!
//! A rotated card measures a part of the forward movement as drift, and a card off the robot's centre moves on an
//! arc when the robot turns. If this is ignored, both look like an error of the mass centre or of a foot.

use lizard_robot::{Place, Travel};

/// The place of the card on the robot, relative to the chassis centre and its forward direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Card {
    /// Rotation against the robot's forward direction, deg, counter-clockwise.
    pub turn: f64,
    /// Distance of the card's centre ahead of the chassis centre, mm.
    pub ahead: f64,
    /// Distance of the card's centre to the left of the chassis centre, mm.
    pub left: f64,
}

/// Number of parameters of a card.
pub(crate) const COUNT: usize = 3;

impl Card {
    /// Standard deviations of the mounting errors of hand-glued cards: deg, mm, mm.
    pub(crate) const PRIOR_ERRORS: [f64; COUNT] = [2.0, 2.0, 2.0];

    /// Converts a movement of the robot to that of the card, in the card's frame at the start.
    pub(crate) fn card_travel(&self, travel: Travel) -> Travel {
        let card_place_of = |body: Place| {
            let [forward, left] = body.to_floor([self.ahead, self.left]);
            let heading = body.heading + self.turn.to_radians();
            Place {
                forward,
                left,
                heading,
            }
        };
        let end = Place {
            forward: travel.forward,
            left: travel.left,
            heading: travel.turn.to_radians(),
        };
        card_place_of(end).travel_from(card_place_of(Place::START))
    }
}

impl From<[f64; COUNT]> for Card {
    fn from([turn, ahead, left]: [f64; COUNT]) -> Self {
        Self { turn, ahead, left }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_seen(card: [f64; COUNT], robot_travel: [f64; 3], expected_travel: [f64; 3]) {
        let [forward, left, turn] = robot_travel;
        let travel = Card::from(card).card_travel(Travel {
            forward,
            left,
            turn,
        });
        let travel = [travel.forward, travel.left, travel.turn];
        for (actual, expected) in travel.into_iter().zip(expected_travel) {
            assert!(
                (actual - expected).abs() < 1e-9,
                "{card:?}: {actual} {expected}"
            );
        }
    }

    #[test]
    fn a_card_in_its_place_goes_as_the_robot_does() {
        assert_seen([0.0; 3], [30.0, 2.0, 15.0], [30.0, 2.0, 15.0]);
    }

    #[test]
    fn a_card_turned_to_the_left_drifts_to_the_right() {
        let (sin, cos) = 30f64.to_radians().sin_cos();
        assert_seen(
            [30.0, 4.0, 5.0],
            [10.0, 0.0, 0.0],
            [10.0 * cos, -10.0 * sin, 0.0],
        );
    }

    #[test]
    fn a_card_ahead_of_the_middle_is_carried_around_it() {
        // A quarter turn about the middle leads from 10 mm ahead to 10 mm to the left.
        assert_seen([0.0, 10.0, 0.0], [0.0, 0.0, 90.0], [-10.0, 10.0, 90.0]);
    }
}
