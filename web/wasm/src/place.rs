//! The body's place on the floor, in the page's coordinates.

use lizard_robot::{BodyPose, Travel};
use serde::{Deserialize, Serialize};
use tsify::Tsify;

/// The position and heading of the chassis on the floor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Tsify)]
pub struct Place {
    /// Distance to the right of the start, mm.
    pub x: f64,
    /// Distance ahead of the start, mm.
    pub y: f64,
    /// Heading, deg, counter-clockwise from the initial heading; not wrapped.
    pub heading: f64,
}

impl Place {
    /// Returns the displacement from this place to another, in this place's frame.
    pub fn displacement_to(self, other: Self) -> Travel {
        BodyPose::from(other).travel_from(self.into())
    }
}

impl From<BodyPose> for Place {
    fn from(pose: BodyPose) -> Self {
        Self {
            x: -pose.left,
            y: pose.forward,
            heading: pose.heading.to_degrees(),
        }
    }
}

impl From<Place> for BodyPose {
    fn from(place: Place) -> Self {
        Self {
            forward: place.y,
            left: -place.x,
            heading: place.heading.to_radians(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displacements_are_in_the_frame_of_the_first_place_and_conversion_is_reversible() {
        let place_at = |x, y, heading| Place { x, y, heading };
        let displacement = place_at(0.0, 0.0, 90.0).displacement_to(place_at(-10.0, -2.0, 95.0));
        let error = (displacement.forward - 10.0)
            .hypot(displacement.left - 2.0)
            .hypot(displacement.turn - 5.0);
        assert!(error < 1e-12, "{displacement:?}");
        let place = place_at(3.0, -4.0, 170.0);
        let converted_place = Place::from(BodyPose::from(place));
        let error = (converted_place.x - 3.0).hypot(converted_place.y + 4.0)
            + (converted_place.heading - 170.0).abs();
        assert!(error < 1e-12, "{converted_place:?}");
    }
}
