//! The measured path: the robot's places at the times of pictures, and between them.

use lizard_contact::{Place, Travel};

use crate::least_squares;

/// Smallest number of pictures to which a parabola is fitted.
const MIN_PICTURES: usize = 4;

/// The robot's place in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Time of the picture, s.
    pub seconds: f64,
    /// The robot's place on the floor; the first strip lies along the forward axis.
    pub place: Place,
}

/// Converts a place relative to `from` into a place on the floor.
pub(crate) fn compose(from: Place, relative: Place) -> Place {
    from.moved_by_travel(relative.travel())
}

/// Inverts a place: the floor's origin relative to `place`.
pub(crate) fn inverse(place: Place) -> Place {
    place_of_travel(Place::START.travel_from(place))
}

/// Converts a movement into the place where it ends, relative to its start.
pub(crate) fn place_of_travel(travel: Travel) -> Place {
    Place::START.moved_by_travel(travel)
}

/// The place at a share of the way along the straight line between two places.
pub(crate) fn interpolate(a: Place, b: Place, share: f64) -> Place {
    Place {
        forward: a.forward + share * (b.forward - a.forward),
        left: a.left + share * (b.left - a.left),
        heading: a.heading + share * (b.heading - a.heading),
    }
}

/// Makes the headings continuous, so that a robot that turned twice has a heading of two full turns.
pub(crate) fn unwrap_headings(path: &mut [PathPoint]) {
    for i in 1..path.len() {
        let previous = path[i - 1].place.heading;
        let turn = path[i].place.heading - previous;
        let whole_turns = (turn / std::f64::consts::TAU).round() * std::f64::consts::TAU;
        path[i].place.heading -= whole_turns;
    }
}

/// The place at a time, interpolated between two pictures; `None` before the first or after the last picture.
pub(crate) fn interpolate_at(path: &[PathPoint], seconds: f64) -> Option<Place> {
    let next_index = path.partition_point(|point| point.seconds < seconds);
    let b = path.get(next_index)?;
    let a = &path[next_index.checked_sub(1).unwrap_or(next_index)];
    let interval = b.seconds - a.seconds;
    let share = if interval > 0.0 {
        (seconds - a.seconds) / interval
    } else {
        1.0
    };
    (share >= 0.0 && seconds >= a.seconds.min(b.seconds))
        .then(|| interpolate(a.place, b.place, share))
}

/// The place at a time, by a parabola fitted to the pictures within `half_window` seconds of it, or to the four nearest
/// ones if there are fewer. `None` if there are no pictures before it or after it.
pub(crate) fn smoothed_place_at(
    path: &[PathPoint],
    seconds: f64,
    half_window: f64,
) -> Option<Place> {
    let mut begin = path.partition_point(|point| point.seconds < seconds - half_window);
    let mut end = path.partition_point(|point| point.seconds <= seconds + half_window);
    while end - begin < MIN_PICTURES {
        if begin == 0 || end == path.len() {
            return None;
        }
        (begin, end) = (begin - 1, end + 1);
    }
    let nearby = &path[begin..end];
    if nearby[0].seconds > seconds || nearby[nearby.len() - 1].seconds < seconds {
        return None;
    }
    let smoothed_coordinate = |coordinate: fn(&Place) -> f64| {
        // A constant curve through the first picture is a sufficient start, because the model is linear.
        let model = |parameters: &[f64]| -> Vec<f64> {
            let residual_of = |point: &PathPoint| {
                let t = (point.seconds - seconds) / half_window;
                parameters[0] + parameters[1] * t + parameters[2] * t * t - coordinate(&point.place)
            };
            nearby.iter().map(residual_of).collect()
        };
        Some(least_squares::fit(&[coordinate(&nearby[0].place), 0.0, 0.0], model)?.parameters[0])
    };
    Some(Place {
        forward: smoothed_coordinate(|place| place.forward)?,
        left: smoothed_coordinate(|place| place.left)?,
        heading: smoothed_coordinate(|place| place.heading)?,
    })
}
