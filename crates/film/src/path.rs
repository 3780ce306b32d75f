//! The measured path: the robot's places at the times of pictures, and between them.

use lizard_contact::{Place, Travel};

use crate::least;

/// Smallest number of pictures to which a parabola is fitted.
const LEAST: usize = 4;

/// The robot's place in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Time of the picture, s.
    pub seconds: f64,
    /// The robot's place on the floor; the first strip lies along the forward axis.
    pub place: Place,
}

/// Converts a place relative to `from` into a place on the floor.
pub(crate) fn compose(from: Place, seen: Place) -> Place {
    from.after(seen.travel())
}

/// Inverts a place: the floor's origin relative to `place`.
pub(crate) fn inverse(place: Place) -> Place {
    of_travel(Place::START.seen_from(place))
}

/// Converts a movement into the place where it ends, relative to its start.
pub(crate) fn of_travel(travel: Travel) -> Place {
    Place::START.after(travel)
}

/// The place at a share of the straight line between two places.
pub(crate) fn interpolate(a: Place, b: Place, share: f64) -> Place {
    Place {
        forward: a.forward + share * (b.forward - a.forward),
        left: a.left + share * (b.left - a.left),
        heading: a.heading + share * (b.heading - a.heading),
    }
}

/// Makes the headings continuous, so that two full turns differ from none.
pub(crate) fn unwind(seen: &mut [PathPoint]) {
    for i in 1..seen.len() {
        let before = seen[i - 1].place.heading;
        let turned = seen[i].place.heading - before;
        let whole = (turned / std::f64::consts::TAU).round() * std::f64::consts::TAU;
        seen[i].place.heading -= whole;
    }
}

/// The place at a time, interpolated between two pictures; `None` before the first or after the last picture.
pub(crate) fn interpolate_at(path: &[PathPoint], seconds: f64) -> Option<Place> {
    let after = path.partition_point(|seen| seen.seconds < seconds);
    let b = path.get(after)?;
    let a = &path[after.checked_sub(1).unwrap_or(after)];
    let apart = b.seconds - a.seconds;
    let share = if apart > 0.0 {
        (seconds - a.seconds) / apart
    } else {
        1.0
    };
    (share >= 0.0 && seconds >= a.seconds.min(b.seconds))
        .then(|| interpolate(a.place, b.place, share))
}

/// The place at a time, by a parabola fitted to the pictures within `half` seconds of it, or to the four nearest
/// ones if there are fewer. `None` if there are no pictures before or after.
pub(crate) fn smoothed_at(path: &[PathPoint], seconds: f64, half: f64) -> Option<Place> {
    let mut begin = path.partition_point(|seen| seen.seconds < seconds - half);
    let mut end = path.partition_point(|seen| seen.seconds <= seconds + half);
    while end - begin < LEAST {
        if begin == 0 || end == path.len() {
            return None;
        }
        (begin, end) = (begin - 1, end + 1);
    }
    let near = &path[begin..end];
    if near[0].seconds > seconds || near[near.len() - 1].seconds < seconds {
        return None;
    }
    let middle = |part: fn(&Place) -> f64| {
        // A constant curve through the first picture is a sufficient start, because the model is linear.
        let model = |at: &[f64]| -> Vec<f64> {
            let residual = |seen: &PathPoint| {
                let t = (seen.seconds - seconds) / half;
                at[0] + at[1] * t + at[2] * t * t - part(&seen.place)
            };
            near.iter().map(residual).collect()
        };
        Some(least::fit(&[part(&near[0].place), 0.0, 0.0], model)?.at[0])
    };
    Some(Place {
        forward: middle(|place| place.forward)?,
        left: middle(|place| place.left)?,
        heading: middle(|place| place.heading)?,
    })
}
