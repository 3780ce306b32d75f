//! The measured path: the robot's places at the times of the frames and between them.

use lizard_contact::{Place, Travel};

use crate::least_squares;

/// Smallest number of frames to which a parabola is fitted.
const MIN_FRAMES: usize = 4;

/// The robot's place at the time of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Time of the frame, s.
    pub seconds: f64,
    /// The robot's place on the floor. The first strip lies along the forward axis.
    pub place: Place,
}

/// Converts a place relative to `from` into a place on the floor.
pub(crate) fn compose(from: Place, relative: Place) -> Place {
    from.moved_by_travel(relative.travel())
}

/// Inverts a place: returns the floor's origin relative to `place`.
pub(crate) fn inverse(place: Place) -> Place {
    travel_to_place(Place::START.travel_from(place))
}

/// Converts a movement into the place where it ends, relative to its start.
pub(crate) fn travel_to_place(travel: Travel) -> Place {
    Place::START.moved_by_travel(travel)
}

/// Interpolates between two places: returns `a` for the fraction 0, `b` for 1.
pub(crate) fn interpolate(a: Place, b: Place, fraction: f64) -> Place {
    Place {
        forward: a.forward + fraction * (b.forward - a.forward),
        left: a.left + fraction * (b.left - a.left),
        heading: a.heading + fraction * (b.heading - a.heading),
    }
}

/// Makes the headings continuous: after two full turns, the heading has increased by two full turns.
pub(crate) fn unwrap_headings(path: &mut [PathPoint]) {
    for i in 1..path.len() {
        let previous = path[i - 1].place.heading;
        let turn = path[i].place.heading - previous;
        let whole_turns = (turn / std::f64::consts::TAU).round() * std::f64::consts::TAU;
        path[i].place.heading -= whole_turns;
    }
}

/// Interpolates the place at a time between two frames; `None` before the first or after the last frame.
pub(crate) fn interpolate_at(path: &[PathPoint], seconds: f64) -> Option<Place> {
    let next_index = path.partition_point(|point| point.seconds < seconds);
    let b = path.get(next_index)?;
    let a = &path[next_index.checked_sub(1).unwrap_or(next_index)];
    let interval = b.seconds - a.seconds;
    let fraction = if interval > 0.0 {
        (seconds - a.seconds) / interval
    } else {
        1.0
    };
    (fraction >= 0.0 && seconds >= a.seconds.min(b.seconds))
        .then(|| interpolate(a.place, b.place, fraction))
}

/// Computes the place at a time from a parabola fitted to the frames within `half_window` seconds of that time, or to
/// at least four frames around it. `None` if there are no frames before or after that time.
pub(crate) fn smoothed_place_at(
    path: &[PathPoint],
    seconds: f64,
    half_window: f64,
) -> Option<Place> {
    let mut begin = path.partition_point(|point| point.seconds < seconds - half_window);
    let mut end = path.partition_point(|point| point.seconds <= seconds + half_window);
    while end - begin < MIN_FRAMES {
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
        // A constant through the first frame is a sufficient start, because the model is linear.
        let model = |parameters: &[f64]| -> Vec<f64> {
            let residual = |point: &PathPoint| {
                let t = (point.seconds - seconds) / half_window;
                parameters[0] + parameters[1] * t + parameters[2] * t * t - coordinate(&point.place)
            };
            nearby.iter().map(residual).collect()
        };
        Some(least_squares::fit(&[coordinate(&nearby[0].place), 0.0, 0.0], model)?.parameters[0])
    };
    Some(Place {
        forward: smoothed_coordinate(|place| place.forward)?,
        left: smoothed_coordinate(|place| place.left)?,
        heading: smoothed_coordinate(|place| place.heading)?,
    })
}
