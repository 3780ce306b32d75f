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
const UNEVEN: f64 = 1.25;
/// Time that is ignored after the start and before the end of the even walk, in cycles.
const MARGIN: f64 = 0.15;

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
    let (walked, [begin, end]) = select_even_walk(path, gait)?;
    let steps = Steps::from_path(walked, gait.period);
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
    let near = HALF_WINDOW * gait.period;
    let places: Vec<(f64, Place)> = times
        .take_while(|&time| time <= end)
        .map(|time| Some((time, path::smoothed_at(path, time, near)?)))
        // The first calm phase may have too few pictures before it.
        .skip_while(Option::is_none)
        .map_while(|place| place)
        .collect();
    if places.len() < 3 {
        return Err(too_short(end - begin, gait));
    }
    let to_calm =
        to_calm(walked, &places, calm, period[0], gait).unwrap_or_else(|| gait.place_at(calm));
    let from_calm = path::inverse(to_calm);
    let travel = |pair: &[(f64, Place)]| {
        let cycle = path::of_travel(pair[1].1.seen_from(pair[0].1));
        path::compose(path::compose(to_calm, cycle), from_calm).travel()
    };
    let begin = |(time, place): &(f64, Place)| PathPoint {
        seconds: time - calm * period[0],
        place: path::compose(*place, from_calm),
    };
    Ok(Cycles {
        period,
        pace: gait.pace(calm),
        ends: places.iter().map(|(time, _)| *time).collect(),
        travels: places.windows(2).map(travel).collect(),
        begins: places.iter().map(begin).collect(),
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
    let first = path.partition_point(|seen| seen.seconds < begin);
    let last = path.partition_point(|seen| seen.seconds <= end);
    let walked = &path[first..last.max(first)];
    if end - begin < 2.0 * gait.period || Steps::from_path(walked, gait.period).are_few() {
        return Err(too_short(end - begin, gait));
    }
    Ok((walked, [begin, end]))
}

fn too_short(seconds: f64, gait: &Gait) -> Trouble {
    Trouble::TooShort {
        cycles: seconds.max(0.0) / gait.period,
        period: gait.period,
    }
}

/// The mean displacement from the beginning of a cycle to its calm phase; `None` if no cycle has pictures before
/// and after its beginning.
fn to_calm(
    path: &[PathPoint],
    places: &[(f64, Place)],
    calm: f64,
    period: f64,
    gait: &Gait,
) -> Option<Place> {
    let ways: Vec<Place> = places
        .iter()
        .filter_map(|(time, place)| {
            let begin = place_at_beginning(path, time - calm * period, period, gait)?;
            Some(path::of_travel(place.seen_from(begin)))
        })
        .collect();
    let mean = |part: fn(&Place) -> f64| ways.iter().map(part).sum::<f64>() / ways.len() as f64;
    (!ways.is_empty()).then(|| Place {
        forward: mean(|way| way.forward),
        left: mean(|way| way.left),
        heading: mean(|way| way.heading),
    })
}

/// The place at the beginning of a cycle: the places in the pictures before and after it are moved to it by the
/// predicted movement, then interpolated. Without the prediction, interpolation would be wrong for a gait that
/// begins with a jerk. `None` if there is no picture before or after.
fn place_at_beginning(path: &[PathPoint], seconds: f64, period: f64, gait: &Gait) -> Option<Place> {
    let after = path.partition_point(|seen| seen.seconds < seconds);
    let (a, b) = (path.get(after.checked_sub(1)?)?, path.get(after)?);
    let by = |seen: &PathPoint| {
        let phase = 1.0 + (seen.seconds - seconds) / period;
        let moved = path::of_travel(gait.place_at(phase).seen_from(gait.place_at(1.0)));
        path::compose(seen.place, path::inverse(moved))
    };
    let share = (seconds - a.seconds) / (b.seconds - a.seconds);
    Some(path::interpolate(by(a), by(b), share))
}

/// Finds the beginning and the end of the time in which the robot walks evenly, s.
fn find_even_walk(path: &[PathPoint], gait: &Gait) -> Result<[f64; 2], Trouble> {
    let moves: Vec<(f64, Travel)> = path
        .iter()
        .filter_map(|seen| {
            let later = path::interpolate_at(path, seen.seconds + gait.period)?;
            Some((seen.seconds, later.seen_from(seen.place)))
        })
        .collect();
    let sizes: Vec<f64> = moves
        .iter()
        .map(|(_, travel)| size(movement(*travel)))
        .collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    if moves.is_empty() {
        let length = path.last().map_or(0.0, |seen| seen.seconds)
            - path.first().map_or(0.0, |seen| seen.seconds);
        return Err(too_short(length, gait));
    }
    if most < MOVED {
        let way = moves
            .iter()
            .map(|(_, travel)| travel.forward.hypot(travel.left));
        return Err(Trouble::NotMoved {
            way: way.fold(0.0, f64::max),
            turn: moves
                .iter()
                .map(|(_, travel)| travel.turn.abs())
                .fold(0.0, f64::max),
        });
    }
    let mut usual: Vec<f64> = sizes
        .iter()
        .copied()
        .filter(|size| *size > most / 2.0)
        .collect();
    usual.sort_by(f64::total_cmp);
    let usual = usual[usual.len() / 2];
    // The longest run of times from which the robot moves as far as usual in a cycle.
    let (mut best, mut run): (Option<[usize; 2]>, Option<usize>) = (None, None);
    for (i, size) in sizes.iter().enumerate() {
        if *size < MIN_EVEN_SHARE * usual {
            run = None;
            continue;
        }
        let from = *run.get_or_insert(i);
        if best.is_none_or(|[a, b]| i - from > b - a) {
            best = Some([from, i]);
        }
    }
    let [from, to] = best.unwrap_or_default();
    let goes = |size: &f64| *size > UNEVEN_SHARE * usual;
    let first = sizes.iter().position(goes).unwrap_or(from);
    let last = sizes.iter().rposition(goes).unwrap_or(to);
    for (start, end, seconds) in [
        (first, from, moves[from].0),
        (to, last, moves[to].0 + gait.period),
    ] {
        if moves[end].0 - moves[start].0 > UNEVEN * gait.period {
            let seconds = seconds - path[0].seconds;
            return Err(Trouble::Changes { seconds });
        }
    }
    let margin = MARGIN * gait.period;
    Ok([moves[from].0 + margin, moves[to].0 + gait.period - margin])
}
