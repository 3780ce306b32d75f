//! The cycles of a path.
//!
//! A distance per cycle means little without the phase at which a cycle starts: the body sways, so the forward
//! direction depends on the phase. A clock error of half a percent causes the same relative error in every cycle.
//! Therefore both phase and clock are fitted (`cycle_timing.rs`). Since frames are some time apart, cycles are measured
//! between calm phases, at which the robot moves evenly. The displacement from the start of a cycle to its calm phase
//! then converts the result to a cycle that is measured from its start.

use lizard_contact::{BodyPose, Travel};

use crate::cycle_timing::{CycleTiming, MAX_MISFIT, MAX_MISFIT_RATIO, Movements, PERIOD_MULTIPLES};
use crate::estimate::Estimate;
use crate::gait::{Gait, HALF_WINDOW, MIN_MOVEMENT, movement_in_mm, movement_length};
use crate::mean;
use crate::path::{self, PathPoint};
use crate::video_error::VideoError;

/// Smallest movement per cycle of an even walk, as a fraction of the usual movement.
const MIN_EVEN_FRACTION: f64 = 0.9;
/// Smallest movement per cycle of an uneven walk, such as a start or a stop, as a fraction of the usual movement.
const MIN_UNEVEN_FRACTION: f64 = 0.25;
/// Longest uneven walk that is allowed before and after the even walk, cycles.
const MAX_UNEVEN_CYCLES: f64 = 1.25;
/// Time that is ignored after the start and before the end of the even walk, cycles.
const MARGIN_CYCLES: f64 = 0.15;

/// The cycles of a path.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cycles {
    /// Duration of a cycle, s.
    pub period: Estimate,
    /// The predicted rate of movement at the calm phase, per cycle: mm, mm, deg.
    pub calm_rate: [f64; 3],
    /// The times of the calm phases at which the path is divided into cycles, s.
    pub boundaries: Vec<f64>,
    /// The movement of each cycle.
    pub travels: Vec<Travel>,
    /// Time and pose of the start of each cycle, and of the last cycle's end.
    pub starts: Vec<PathPoint>,
    /// Standard error of the times in `starts`, s.
    pub start_error: f64,
}

/// Finds the cycles of a path.
///
/// # Errors
/// Fails if the robot does not move, does not move like the gait, changes its movement, or walks for less than two
/// cycles.
pub(crate) fn find_cycles(path: &[PathPoint], gait: &Gait) -> Result<Cycles, VideoError> {
    let selection =
        select_even_walk(path, gait).map_err(|error| match find_slow_pace(path, gait) {
            Some((misfit, ratio)) if misfit < MAX_MISFIT => VideoError::WrongPace { ratio },
            _ => error,
        });
    let (walk, [begin, end], movements) = selection?;
    let CycleTiming { start, period } = movements.fit_timing(gait)?;
    if let Some(seconds) = movements.find_change(period.value) {
        let seconds = seconds - path[0].seconds;
        return Err(VideoError::MovementChanges { seconds });
    }
    let calm_phase = gait.find_calm_phase();
    // The times of the calm phases within the walk.
    let first = ((begin - start.value) / period.value - calm_phase).ceil() as i64;
    let times = (first..).map(|i| start.value + (i as f64 + calm_phase) * period.value);
    let half_window = HALF_WINDOW * gait.period;
    let calm_point_at = |seconds: f64| {
        let pose = path::smoothed_pose_at(path, seconds, half_window)?;
        Some(PathPoint { seconds, pose })
    };
    let calm_points: Vec<PathPoint> = times
        .take_while(|&time| time <= end)
        .map(calm_point_at)
        // The first calm phase may have too few frames before it.
        .skip_while(Option::is_none)
        .map_while(|point| point)
        .collect();
    if calm_points.len() < 3 {
        return Err(too_short_error(end - begin, gait));
    }
    let seconds_at_start = |point: &PathPoint| point.seconds - calm_phase * period.value;
    let displacement_to = |point: &PathPoint| {
        let start_pose = pose_at_start(walk, seconds_at_start(point), period.value, gait)?;
        Some(path::pose_from_travel(point.pose.travel_from(start_pose)))
    };
    let displacements: Vec<BodyPose> = calm_points.iter().filter_map(displacement_to).collect();
    // The mean displacement from the start of a cycle to its calm phase, or the predicted one if no cycle has frames
    // both before and after its start.
    let start_to_calm = match displacements.is_empty() {
        true => gait.pose_at(calm_phase),
        false => mean_pose(&displacements),
    };
    let calm_to_start = path::inverse(start_to_calm);
    let cycle_travel = |pair: &[PathPoint]| {
        let cycle = path::pose_from_travel(pair[1].pose.travel_from(pair[0].pose));
        path::compose(path::compose(start_to_calm, cycle), calm_to_start).travel()
    };
    let cycle_start = |point: &PathPoint| PathPoint {
        seconds: seconds_at_start(point),
        pose: path::compose(point.pose, calm_to_start),
    };
    Ok(Cycles {
        period,
        calm_rate: gait.rate_at(calm_phase),
        boundaries: calm_points.iter().map(|point| point.seconds).collect(),
        travels: calm_points.windows(2).map(cycle_travel).collect(),
        starts: calm_points.iter().map(cycle_start).collect(),
        start_error: start.standard_error,
    })
}

/// Selects the part of a path on which the robot walks evenly; returns it with the times of its start and end, s, and
/// its movements. Fails if the movements are too few for a comparison with a gait.
pub(crate) fn select_even_walk<'a>(
    path: &'a [PathPoint],
    gait: &Gait,
) -> Result<(&'a [PathPoint], [f64; 2], Movements), VideoError> {
    let [begin, end] = find_even_walk(path, gait)?;
    let walk = path::between(path, [begin, end]);
    let movements = Movements::from_path(walk, gait.period);
    if end - begin < 2.0 * gait.period || movements.are_too_few() {
        return Err(too_short_error(end - begin, gait));
    }
    Ok((walk, [begin, end], movements))
}

/// Finds the multiple of a gait's cycle duration with which a path shows the gait if its cycles look uneven at the
/// usual duration. Returns the misfit and the multiple; `None` if no multiple fits much better than the usual duration.
pub(crate) fn find_slow_pace(path: &[PathPoint], gait: &Gait) -> Option<(f64, u32)> {
    let fits = PERIOD_MULTIPLES.into_iter().filter_map(|multiple| {
        let mut slow_gait = gait.clone();
        slow_gait.period *= f64::from(multiple);
        let (walk, _, movements) = select_even_walk(path, &slow_gait).ok()?;
        let misfit = movements.compute_misfit(&slow_gait);
        // A robot at its usual pace that slips now and then also resembles the slow gait, but not much better.
        let usual_misfit = Movements::from_path(walk, gait.period).compute_misfit(gait);
        (misfit < MAX_MISFIT_RATIO * usual_misfit.min(1.0)).then_some((misfit, multiple))
    });
    fits.min_by(|a, b| a.0.total_cmp(&b.0))
}

fn too_short_error(seconds: f64, gait: &Gait) -> VideoError {
    VideoError::TooShort {
        cycles: seconds.max(0.0) / gait.period,
        period: gait.period,
    }
}

/// Computes the mean of poses, coordinate by coordinate.
fn mean_pose(poses: &[BodyPose]) -> BodyPose {
    let mean_coordinate = |coordinate: fn(&BodyPose) -> f64| {
        poses.iter().map(coordinate).sum::<f64>() / poses.len() as f64
    };
    BodyPose {
        forward: mean_coordinate(|pose| pose.forward),
        left: mean_coordinate(|pose| pose.left),
        heading: mean_coordinate(|pose| pose.heading),
    }
}

/// Computes the pose at the start of a cycle: shifts the poses in the frames before and after the start to that time
/// by the predicted movement, then interpolates. Without the prediction, interpolation would be wrong for a gait that
/// starts with a jerk. `None` if there is no frame before or after the start.
fn pose_at_start(path: &[PathPoint], seconds: f64, period: f64, gait: &Gait) -> Option<BodyPose> {
    let next_index = path.partition_point(|point| point.seconds < seconds);
    let (a, b) = (path.get(next_index.checked_sub(1)?)?, path.get(next_index)?);
    let shifted_pose = |point: &PathPoint| {
        let phase = 1.0 + (point.seconds - seconds) / period;
        let displacement =
            path::pose_from_travel(gait.pose_at(phase).travel_from(gait.pose_at(1.0)));
        path::compose(point.pose, path::inverse(displacement))
    };
    let fraction = (seconds - a.seconds) / (b.seconds - a.seconds);
    let [a, b] = [a, b].map(shifted_pose);
    Some(path::interpolate(a, b, fraction))
}

/// Finds the start and the end of the time in which the robot walks evenly, s.
fn find_even_walk(path: &[PathPoint], gait: &Gait) -> Result<[f64; 2], VideoError> {
    let travel_from = |point: &PathPoint| {
        let later_pose = path::interpolate_at(path, point.seconds + gait.period)?;
        Some((point.seconds, later_pose.travel_from(point.pose)))
    };
    let travels: Vec<(f64, Travel)> = path.iter().filter_map(travel_from).collect();
    let length = |(_, travel): &(f64, Travel)| movement_length(movement_in_mm(*travel));
    let movement_lengths: Vec<f64> = travels.iter().map(length).collect();
    let max_length = movement_lengths.iter().copied().fold(0.0, f64::max);
    if travels.is_empty() {
        let duration = path.last().map_or(0.0, |point| point.seconds)
            - path.first().map_or(0.0, |point| point.seconds);
        return Err(too_short_error(duration, gait));
    }
    if max_length < MIN_MOVEMENT {
        let max = |size: fn(&Travel) -> f64| {
            let sizes = travels.iter().map(|(_, travel)| size(travel));
            sizes.fold(0.0, f64::max)
        };
        let distance = max(|travel| travel.forward.hypot(travel.left));
        let turn = max(|travel| travel.turn.abs());
        return Err(VideoError::NoMovement { distance, turn });
    }
    let mut large_lengths = movement_lengths.clone();
    large_lengths.retain(|length| *length > max_length / 2.0);
    let usual_length = mean::median(large_lengths).unwrap_or(max_length);
    // Finds the longest run of frames after each of which the robot moves as far as usual within a cycle.
    let (mut longest_run, mut run_begin): (Option<[usize; 2]>, Option<usize>) = (None, None);
    for (i, length) in movement_lengths.iter().enumerate() {
        if *length < MIN_EVEN_FRACTION * usual_length {
            run_begin = None;
            continue;
        }
        let begin = *run_begin.get_or_insert(i);
        if longest_run.is_none_or(|[a, b]| i - begin > b - a) {
            longest_run = Some([begin, i]);
        }
    }
    let [even_begin, even_end] = longest_run.unwrap_or_default();
    let is_moving = |length: &f64| *length > MIN_UNEVEN_FRACTION * usual_length;
    let first = movement_lengths.iter().position(is_moving);
    let last = movement_lengths.iter().rposition(is_moving);
    let (first, last) = (first.unwrap_or(even_begin), last.unwrap_or(even_end));
    for (start, end, seconds) in [
        (first, even_begin, travels[even_begin].0),
        (even_end, last, travels[even_end].0 + gait.period),
    ] {
        if travels[end].0 - travels[start].0 > MAX_UNEVEN_CYCLES * gait.period {
            let seconds = seconds - path[0].seconds;
            return Err(VideoError::MovementChanges { seconds });
        }
    }
    let margin = MARGIN_CYCLES * gait.period;
    Ok([
        travels[even_begin].0 + margin,
        travels[even_end].0 + gait.period - margin,
    ])
}
