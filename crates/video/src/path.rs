//! The measured path: the robot's poses at the times of the frames and between them.

use lizard_contact::{BodyPose, Travel};

use crate::least_squares;

/// Smallest number of frames to which a parabola is fitted.
const MIN_FRAMES: usize = 4;

/// The robot's pose at the time of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Time of the frame, s.
    pub seconds: f64,
    /// The robot's pose on the floor. The first strip lies along the forward axis.
    pub pose: BodyPose,
}

/// Converts a pose relative to `from` into a pose on the floor.
pub(crate) fn compose(from: BodyPose, relative: BodyPose) -> BodyPose {
    from.moved_by_travel(relative.travel())
}

/// Inverts a pose: returns the floor's origin relative to `pose`.
pub(crate) fn inverse(pose: BodyPose) -> BodyPose {
    pose_from_travel(BodyPose::START.travel_from(pose))
}

/// Converts a movement into the pose where it ends, relative to its start.
pub(crate) fn pose_from_travel(travel: Travel) -> BodyPose {
    BodyPose::START.moved_by_travel(travel)
}

/// Interpolates between two poses: returns `a` for the fraction 0, `b` for 1.
pub(crate) fn interpolate(a: BodyPose, b: BodyPose, fraction: f64) -> BodyPose {
    BodyPose {
        forward: a.forward + fraction * (b.forward - a.forward),
        left: a.left + fraction * (b.left - a.left),
        heading: a.heading + fraction * (b.heading - a.heading),
    }
}

/// Makes the headings continuous: after two full turns, the heading has increased by two full turns.
pub(crate) fn unwrap_headings(path: &mut [PathPoint]) {
    for i in 1..path.len() {
        let previous = path[i - 1].pose.heading;
        let turn = path[i].pose.heading - previous;
        let whole_turns = (turn / std::f64::consts::TAU).round();
        path[i].pose.heading -= whole_turns * std::f64::consts::TAU;
    }
}

/// Returns the part of a path between two times, s.
pub(crate) fn between(path: &[PathPoint], [from, to]: [f64; 2]) -> &[PathPoint] {
    let begin = path.partition_point(|point| point.seconds < from);
    let end = path.partition_point(|point| point.seconds <= to);
    &path[begin..end.max(begin)]
}

/// Interpolates the pose at a time between two frames; `None` until the first frame and after the last frame.
pub(crate) fn interpolate_at(path: &[PathPoint], seconds: f64) -> Option<BodyPose> {
    let next_index = path.partition_point(|point| point.seconds < seconds);
    let (a, b) = (path.get(next_index.checked_sub(1)?)?, path.get(next_index)?);
    let fraction = (seconds - a.seconds) / (b.seconds - a.seconds);
    Some(interpolate(a.pose, b.pose, fraction))
}

/// Computes the pose at a time from a parabola fitted to the frames within `half_window` seconds of that time. A window
/// with fewer than four frames is widened at both ends until it has four. `None` if the path ends before that, if all
/// frames of the window are before or after that time, or if the fit fails.
pub(crate) fn smoothed_pose_at(
    path: &[PathPoint],
    seconds: f64,
    half_window: f64,
) -> Option<BodyPose> {
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
    let smoothed_coordinate = |coordinate: fn(&BodyPose) -> f64| {
        // Any initial guess suffices, because the residuals are linear in the parameters. This one is the value in the
        // first frame.
        let residuals = |parameters: &[f64]| -> Vec<f64> {
            let residual = |point: &PathPoint| {
                let t = (point.seconds - seconds) / half_window;
                parameters[0] + parameters[1] * t + parameters[2] * t * t - coordinate(&point.pose)
            };
            nearby.iter().map(residual).collect()
        };
        Some(least_squares::fit(&[coordinate(&nearby[0].pose), 0.0, 0.0], residuals)?.parameters[0])
    };
    Some(BodyPose {
        forward: smoothed_coordinate(|pose| pose.forward)?,
        left: smoothed_coordinate(|pose| pose.left)?,
        heading: smoothed_coordinate(|pose| pose.heading)?,
    })
}
