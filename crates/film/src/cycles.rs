//! The cycles of a path.
//!
//! A way per cycle means little without the phase at which a cycle begins: the body sways, so
//! another beginning has another direction ahead. And a clock that is off by half a percent makes every cycle
//! as much too long. So the beginning and the time of a cycle are fitted: the movement within a cycle must
//! fit the predicted one. Its size does not count for that, only its ups and downs. Cycles are compared
//! at a time at which the robot moves evenly, since pictures are apart, and the result is seen from a cycle's
//! beginning by the way from there to that time.

use lizard_contact::{Place, Travel};

use crate::least;
use crate::path::{self, Seen};
use crate::trouble::Trouble;

/// Weight of a turn, mm for each rad: the robot's legs are as far from its middle.
const ARM: f64 = 60.0;
/// Least movement in the time of a cycle, mm.
const MOVED: f64 = 3.0;
/// Share of the usual movement in the time of a cycle from which the robot counts as walking.
const WALKS: f64 = 0.9;
/// Part of a cycle that is left out after the start and before the stop.
const MARGIN: f64 = 0.15;
/// Part of a cycle over which the movement is compared with the predicted one.
const PART: f64 = 0.25;
/// Standard deviation of a cycle's time: the board has a ceramic resonator.
const CLOCK: f64 = 0.003;
/// Half of the time whose pictures tell the place at the end of a cycle, in cycles.
const NEAR: f64 = 0.08;
/// Number of beginnings that are tried.
const BEGINNINGS: usize = 48;
/// Difference from the predicted movement, of the sum of both squares, from which it is another gait.
const ANOTHER: f64 = 0.5;

/// A gait as it is predicted.
#[derive(Debug, Clone, PartialEq)]
pub struct Gait {
    /// Time of a cycle at the pace that was driven, s.
    pub period: f64,
    /// The path of a cycle, evenly in time, seen from its start; the last place is its end.
    pub path: Vec<Place>,
}

impl Gait {
    /// The place at a phase, seen from the start of cycle 0.
    fn at(&self, phase: f64) -> Place {
        let count = self.path.len() - 1;
        let within = phase.rem_euclid(1.0) * count as f64;
        let i = (within as usize).min(count - 1);
        let (a, b, share) = (self.path[i], self.path[i + 1], within - i as f64);
        let mut place = path::mix(a, b, share);
        for _ in 0..phase.floor().max(0.0) as usize {
            place = path::compose(self.path[count], place);
        }
        place
    }

    /// The phase around which the predicted movement changes least: there a place between
    /// pictures is known best.
    fn calm(&self) -> f64 {
        let count = 50;
        let roughness = |i: usize| {
            let part = |j: f64| {
                let from = (i as f64 + j) / count as f64;
                self.step(from, from + 1.0 / count as f64)
            };
            let parts = [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0].map(part);
            let changes = parts
                .windows(2)
                .map(|pair| size([0, 1, 2].map(|axis| pair[1][axis] - pair[0][axis])));
            // Half as much counts a movement itself, because the clock is not known exactly.
            changes.sum::<f64>() + 0.5 * parts.iter().map(|part| size(*part)).sum::<f64>()
        };
        let least = (0..count).min_by(|&a, &b| roughness(a).total_cmp(&roughness(b)));
        least.unwrap_or(0) as f64 / count as f64
    }

    /// The movement at a phase, for a whole cycle: mm, mm, deg.
    fn pace(&self, phase: f64) -> [f64; 3] {
        let [forward, left, turn] = self.step(phase - NEAR / 2.0, phase + NEAR / 2.0);
        [forward, left, (turn / ARM).to_degrees()].map(|part| part / NEAR)
    }

    /// The movement from a phase to a later one.
    fn step(&self, from: f64, to: f64) -> [f64; 3] {
        let whole = from.floor();
        movement(self.at(to - whole).seen_from(self.at(from - whole)))
    }
}

/// The cycles of a path.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cycles {
    /// Time of a cycle, s, and its standard error.
    pub period: [f64; 2],
    /// The predicted movement at the times between cycles, for a whole cycle: mm, mm, deg.
    pub pace: [f64; 3],
    /// The times between cycles, s.
    pub ends: Vec<f64>,
    /// The movement of each cycle.
    pub travels: Vec<Travel>,
}

/// A movement in mm: ahead, left, turn on the arm.
fn movement(travel: Travel) -> [f64; 3] {
    [travel.forward, travel.left, ARM * travel.turn.to_radians()]
}

fn size(movement: [f64; 3]) -> f64 {
    movement.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// Finds the cycles of a path.
///
/// # Errors
/// Fails if the robot does not move, moves otherwise than the gait, or for less than two cycles.
pub(crate) fn find(path: &[Seen], gait: &Gait) -> Result<Cycles, Trouble> {
    let [begin, end] = walk(path, gait)?;
    let walked: Vec<Seen> = path
        .iter()
        .filter(|seen| (begin..=end).contains(&seen.seconds))
        .copied()
        .collect();
    let steps = steps(&walked, PART * gait.period);
    let too_short = Trouble::TooShort {
        cycles: (end - begin).max(0.0) / gait.period,
        period: gait.period,
    };
    if steps.len() < 8 || end - begin < 2.0 * gait.period {
        return Err(too_short);
    }
    let (start, period) = clock(&steps, gait)?;
    let calm = gait.calm();
    // The calm times of cycles from before the walk to after it.
    let first = ((begin - start) / period[0] - calm).ceil() as i64;
    let times = (first..).map(|i| start + (i as f64 + calm) * period[0]);
    let near = NEAR * gait.period;
    let places: Vec<(f64, Place)> = times
        .take_while(|&time| time <= end)
        .map_while(|time| Some((time, path::at(path, time, near)?)))
        .collect();
    if places.len() < 3 {
        return Err(too_short);
    }
    let to_calm = to_calm(&walked, &places, calm * period[0]).unwrap_or_else(|| gait.at(calm));
    let from_calm = path::inverse(to_calm);
    let travel = |pair: &[(f64, Place)]| {
        let cycle = path::of_travel(pair[1].1.seen_from(pair[0].1));
        path::compose(path::compose(to_calm, cycle), from_calm).travel()
    };
    Ok(Cycles {
        period,
        pace: gait.pace(calm),
        ends: places.iter().map(|(time, _)| *time).collect(),
        travels: places.windows(2).map(travel).collect(),
    })
}

/// The mean way from the beginning of a cycle to its calm time.
fn to_calm(path: &[Seen], places: &[(f64, Place)], calm: f64) -> Option<Place> {
    let ways: Vec<Place> = places
        .iter()
        .filter_map(|(time, place)| {
            let begin = path::between(path, time - calm)?;
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

/// The time in which the robot walks evenly.
fn walk(path: &[Seen], gait: &Gait) -> Result<[f64; 2], Trouble> {
    let moves: Vec<(f64, Travel)> = path
        .iter()
        .filter_map(|seen| {
            let later = path::between(path, seen.seconds + gait.period)?;
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
        return Err(Trouble::TooShort {
            cycles: length / gait.period,
            period: gait.period,
        });
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
    // The longest run of times from which on it moves as far as usual.
    let (mut best, mut run): (Option<[usize; 2]>, Option<usize>) = (None, None);
    for (i, size) in sizes.iter().enumerate() {
        if *size < WALKS * usual {
            run = None;
            continue;
        }
        let from = *run.get_or_insert(i);
        if best.is_none_or(|[a, b]| i - from > b - a) {
            best = Some([from, i]);
        }
    }
    let [from, to] = best.unwrap_or_default();
    let margin = MARGIN * gait.period;
    Ok([moves[from].0 + margin, moves[to].0 + gait.period - margin])
}

/// The movement from each picture to a later time: the time of the picture, the movement.
fn steps(path: &[Seen], later: f64) -> Vec<(f64, [f64; 3])> {
    let step = |seen: &Seen| {
        let there = path::between(path, seen.seconds + later)?;
        Some((seen.seconds, movement(there.seen_from(seen.place))))
    };
    path.iter().filter_map(step).collect()
}

/// The beginning of a cycle and the time of a cycle, s, with its standard error.
fn clock(steps: &[(f64, [f64; 3])], gait: &Gait) -> Result<(f64, [f64; 2]), Trouble> {
    let part = PART * gait.period;
    let predicted = |start: f64, period: f64| -> Vec<[f64; 3]> {
        let of = |(time, _): &(f64, [f64; 3])| {
            let phase = (time - start) / period;
            gait.step(phase, phase + part / period)
        };
        steps.iter().map(of).collect()
    };
    let mean = |all: &mut dyn Iterator<Item = [f64; 3]>| {
        let sum = all.fold([0.0; 3], |sum, step| [0, 1, 2].map(|i| sum[i] + step[i]));
        sum.map(|part| part / steps.len() as f64)
    };
    let seen_mean = mean(&mut steps.iter().map(|(_, step)| *step));
    let differences = |start: f64, period: f64| -> Vec<f64> {
        let predicted = predicted(start, period);
        let predicted_mean = mean(&mut predicted.iter().copied());
        let pairs = steps.iter().zip(&predicted);
        pairs
            .flat_map(|((_, seen), predicted)| {
                [0, 1, 2].map(|i| (seen[i] - seen_mean[i]) - (predicted[i] - predicted_mean[i]))
            })
            .collect()
    };
    let squares = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    let first = steps[0].0;
    let starts = (0..BEGINNINGS).map(|i| first + gait.period * i as f64 / BEGINNINGS as f64);
    let tries = starts.flat_map(|start| {
        [-2.0, -1.0, 0.0, 1.0, 2.0].map(|sigmas| (start, gait.period * (1.0 + CLOCK * sigmas)))
    });
    let tries = tries.map(|(start, period)| {
        // The middle of the film keeps its phase while the time of a cycle changes.
        let middle = (steps[steps.len() / 2].0 - first) / gait.period;
        let start = start + middle.floor() * (gait.period - period);
        (squares(&differences(start, period)), start, period)
    });
    let best = tries.min_by(|a, b| a.0.total_cmp(&b.0));
    let (least, start, period) = best.unwrap_or((0.0, first, gait.period));
    let total: f64 = predicted(start, period)
        .iter()
        .zip(steps)
        .map(|(predicted, (_, seen))| {
            let differ = [0, 1, 2].map(|i| predicted[i] - seen[i]);
            size(differ).powi(2) - ANOTHER * (size(*predicted).powi(2) + size(*seen).powi(2))
        })
        .sum();
    if total > 0.0 {
        return Err(Trouble::NotThisGait {
            period: gait.period,
        });
    }
    let sigma = (least / (3 * steps.len()) as f64).sqrt().max(1e-3);
    let model = |at: &[f64]| {
        let mut all = differences(at[0], at[1]);
        all.iter_mut().for_each(|value| *value /= sigma);
        all.push((at[1] / gait.period - 1.0) / CLOCK);
        // Keeps the start where nothing within a cycle tells it.
        all.push((at[0] - start) / gait.period);
        all
    };
    Ok(match least::fit(&[start, period], model) {
        Some(fit) => (fit.at[0], [fit.at[1], fit.covariance[(1, 1)].sqrt()]),
        None => (start, [period, CLOCK * gait.period]),
    })
}
