//! The cycles of a path.
//!
//! A distance per cycle means little without the phase at which a cycle begins: the body sways, so another phase
//! has another forward direction. And a clock that is off by half a percent makes every cycle too long by as much.
//! So both are fitted (`clock.rs`). Cycles are compared at a calm phase, at which the robot moves evenly, since
//! pictures are some time apart. The displacement from the beginning of a cycle to its calm phase then converts the
//! result to one that is measured from the beginning.

use lizard_contact::{Place, Travel};

use crate::clock::{Clock, Steps};
use crate::gait::{Gait, HALF_WINDOW, MOVED, movement, size};
use crate::path::{self, PathPoint};
use crate::trouble::Trouble;

/// Smallest share of the usual movement per cycle for the robot to count as walking evenly.
const MIN_EVEN_SHARE: f64 = 0.9;
/// Smallest share of the usual movement per cycle for the robot to count as walking unevenly, as when it starts or
/// stops.
const UNEVEN_SHARE: f64 = 0.25;
/// Longest time for which the robot may walk unevenly before and after the even walk, in cycles.
const MAX_UNEVEN_CYCLES: f64 = 1.25;
/// Time that is ignored after the start and before the end of the even walk, in cycles.
const MARGIN_CYCLES: f64 = 0.15;

/// The cycles of a path.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cycles {
    /// Duration of a cycle, s, and its standard error.
    pub period: [f64; 2],
    /// The predicted movement at the calm phase, scaled to an entire cycle: mm, mm, deg.
    pub pace: [f64; 3],
    /// The times of the calm phases that separate the cycles, s.
    pub ends: Vec<f64>,
    /// The movement of each cycle.
    pub travels: Vec<Travel>,
    /// Time and place of the beginning of each cycle, and of the end of the last one.
    pub begins: Vec<PathPoint>,
    /// Standard error of the times in `begins`, s.
    pub begin_error: f64,
}

/// Finds the cycles of a path.
///
/// # Errors
/// Fails if the robot does not move, moves differently from the gait, changes its movement, or walks for less than
/// two cycles.
pub(crate) fn find(path: &[PathPoint], gait: &Gait) -> Result<Cycles, Trouble> {
    let (walk, [begin, end]) = select_even_walk(path, gait)?;
    let steps = Steps::from_path(walk, gait.period);
    let Clock {
        start: [start, begin_error],
        period,
    } = steps.clock(gait)?;
    if let Some(seconds) = steps.change(period[0]) {
        let seconds = seconds - path[0].seconds;
        return Err(Trouble::Changes { seconds });
    }
    let calm = gait.calm_phase();
    // The times of the calm phases within the walk.
    let first = ((begin - start) / period[0] - calm).ceil() as i64;
    let times = (first..).map(|i| start + (i as f64 + calm) * period[0]);
    let half_window = HALF_WINDOW * gait.period;
    let places: Vec<(f64, Place)> = times
        .take_while(|&time| time <= end)
        .map(|time| Some((time, path::smoothed_at(path, time, half_window)?)))
        // The first calm phase may have too few pictures before it.
        .skip_while(Option::is_none)
        .map_while(|place| place)
        .collect();
    if places.len() < 3 {
        return Err(too_short_error(end - begin, gait));
    }
    let start_to_calm = displacement_to_calm(walk, &places, calm, period[0], gait)
        .unwrap_or_else(|| gait.place_at(calm));
    let calm_to_start = path::inverse(start_to_calm);
    let travel_of = |pair: &[(f64, Place)]| {
        let cycle = path::of_travel(pair[1].1.seen_from(pair[0].1));
        path::compose(path::compose(start_to_calm, cycle), calm_to_start).travel()
    };
    let beginning_of = |(time, place): &(f64, Place)| PathPoint {
        seconds: time - calm * period[0],
        place: path::compose(*place, calm_to_start),
    };
    Ok(Cycles {
        period,
        pace: gait.pace(calm),
        ends: places.iter().map(|(time, _)| *time).collect(),
        travels: places.windows(2).map(travel_of).collect(),
        begins: places.iter().map(beginning_of).collect(),
        begin_error,
    })
}

/// Computes the movements while the robot walks evenly; fails if they are too few for a comparison with a gait.
pub(crate) fn steps(path: &[PathPoint], gait: &Gait) -> Result<Steps, Trouble> {
    Ok(Steps::from_path(
        select_even_walk(path, gait)?.0,
        gait.period,
    ))
}

/// Selects the part of a path on which the robot walks evenly; returns it with the times of its beginning and end,
/// s.
fn select_even_walk<'a>(
    path: &'a [PathPoint],
    gait: &Gait,
) -> Result<(&'a [PathPoint], [f64; 2]), Trouble> {
    let [begin, end] = find_even_walk(path, gait)?;
    let first = path.partition_point(|point| point.seconds < begin);
    let last = path.partition_point(|point| point.seconds <= end);
    let walk = &path[first..last.max(first)];
    if end - begin < 2.0 * gait.period || Steps::from_path(walk, gait.period).are_few() {
        return Err(too_short_error(end - begin, gait));
    }
    Ok((walk, [begin, end]))
}

fn too_short_error(seconds: f64, gait: &Gait) -> Trouble {
    Trouble::TooShort {
        cycles: seconds.max(0.0) / gait.period,
        period: gait.period,
    }
}

/// The mean displacement from the beginning of a cycle to its calm phase; `None` if no cycle has pictures before
/// and after its beginning.
fn displacement_to_calm(
    path: &[PathPoint],
    places: &[(f64, Place)],
    calm: f64,
    period: f64,
    gait: &Gait,
) -> Option<Place> {
    let displacements: Vec<Place> = places
        .iter()
        .filter_map(|(time, place)| {
            let begin = place_at_beginning(path, time - calm * period, period, gait)?;
            Some(path::of_travel(place.seen_from(begin)))
        })
        .collect();
    let mean_of = |coordinate: fn(&Place) -> f64| {
        displacements.iter().map(coordinate).sum::<f64>() / displacements.len() as f64
    };
    (!displacements.is_empty()).then(|| Place {
        forward: mean_of(|displacement| displacement.forward),
        left: mean_of(|displacement| displacement.left),
        heading: mean_of(|displacement| displacement.heading),
    })
}

/// The place at the beginning of a cycle: the places in the pictures before and after it are moved to it by the
/// predicted movement, then interpolated. Without the prediction, interpolation would be wrong for a gait that
/// begins with a jerk. `None` if there is no picture before or after.
fn place_at_beginning(path: &[PathPoint], seconds: f64, period: f64, gait: &Gait) -> Option<Place> {
    let next_index = path.partition_point(|point| point.seconds < seconds);
    let (a, b) = (path.get(next_index.checked_sub(1)?)?, path.get(next_index)?);
    let moved_place = |point: &PathPoint| {
        let phase = 1.0 + (point.seconds - seconds) / period;
        let displacement = path::of_travel(gait.place_at(phase).seen_from(gait.place_at(1.0)));
        path::compose(point.place, path::inverse(displacement))
    };
    let share = (seconds - a.seconds) / (b.seconds - a.seconds);
    Some(path::interpolate(moved_place(a), moved_place(b), share))
}

/// Finds the beginning and the end of the time in which the robot walks evenly, s.
fn find_even_walk(path: &[PathPoint], gait: &Gait) -> Result<[f64; 2], Trouble> {
    let moves: Vec<(f64, Travel)> = path
        .iter()
        .filter_map(|point| {
            let later_place = path::interpolate_at(path, point.seconds + gait.period)?;
            Some((point.seconds, later_place.seen_from(point.place)))
        })
        .collect();
    let sizes: Vec<f64> = moves
        .iter()
        .map(|(_, travel)| size(movement(*travel)))
        .collect();
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    if moves.is_empty() {
        let duration = path.last().map_or(0.0, |point| point.seconds)
            - path.first().map_or(0.0, |point| point.seconds);
        return Err(too_short_error(duration, gait));
    }
    if largest < MOVED {
        let distances = moves
            .iter()
            .map(|(_, travel)| travel.forward.hypot(travel.left));
        return Err(Trouble::NotMoved {
            way: distances.fold(0.0, f64::max),
            turn: moves
                .iter()
                .map(|(_, travel)| travel.turn.abs())
                .fold(0.0, f64::max),
        });
    }
    let mut large_sizes: Vec<f64> = sizes
        .iter()
        .copied()
        .filter(|size| *size > largest / 2.0)
        .collect();
    large_sizes.sort_by(f64::total_cmp);
    let usual_size = large_sizes[large_sizes.len() / 2];
    // The longest run of times from which the robot moves as far as usual in a cycle.
    let (mut longest_run, mut run_start): (Option<[usize; 2]>, Option<usize>) = (None, None);
    for (i, size) in sizes.iter().enumerate() {
        if *size < MIN_EVEN_SHARE * usual_size {
            run_start = None;
            continue;
        }
        let from = *run_start.get_or_insert(i);
        if longest_run.is_none_or(|[a, b]| i - from > b - a) {
            longest_run = Some([from, i]);
        }
    }
    let [from, to] = longest_run.unwrap_or_default();
    let is_moving = |size: &f64| *size > UNEVEN_SHARE * usual_size;
    let first = sizes.iter().position(is_moving).unwrap_or(from);
    let last = sizes.iter().rposition(is_moving).unwrap_or(to);
    for (start, end, seconds) in [
        (first, from, moves[from].0),
        (to, last, moves[to].0 + gait.period),
    ] {
        if moves[end].0 - moves[start].0 > MAX_UNEVEN_CYCLES * gait.period {
            let seconds = seconds - path[0].seconds;
            return Err(Trouble::Changes { seconds });
        }
    }
    let margin = MARGIN_CYCLES * gait.period;
    Ok([moves[from].0 + margin, moves[to].0 + gait.period - margin])
}
