//! The mean path within a cycle, compared with the predicted one.
//!
//! Pictures are taken at any phase, and a straight line between two of them is not the path. So the place in each
//! picture is compared with the predicted place at the same phase. The differences change slowly, and are averaged
//! over parts of the cycle.

use lizard_contact::Travel;

use crate::cycles::Cycles;
use crate::gait::Gait;
use crate::mean::{self, Mean};
use crate::path::PathPoint;
use crate::walk::{Deviation, Walk};

/// Largest number of parts of a cycle; each part should have at least one picture.
const PARTS: usize = 24;

/// A point of the mean path within a cycle, relative to the cycle's beginning: forward and left, mm, and turn, deg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Phase, 0 to 1: the middle of the part of the cycle that the point stands for.
    pub phase: f64,
    /// The measured place with its spread and error.
    pub measured: [Mean; 3],
    /// The predicted place.
    pub predicted: [f64; 3],
}

impl Point {
    /// The measured place minus the predicted one, in standard errors: forward, left, turn.
    pub fn standardized_differences(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let Mean { mean, error, .. } = self.measured[axis];
            (mean - self.predicted[axis]) / error.max(1e-6)
        })
    }
}

/// Computes the deviation of each picture within a cycle from the predicted path.
pub(crate) fn find_deviations(path: &[PathPoint], cycles: &Cycles, gait: &Gait) -> Vec<Deviation> {
    let mut offs = Vec::new();
    for (cycle, pair) in cycles.begins.windows(2).enumerate() {
        let (begin, end) = (pair[0], pair[1].seconds);
        let inside = |seen: &&PathPoint| (begin.seconds..end).contains(&seen.seconds);
        for seen in path.iter().filter(inside) {
            let phase = (seen.seconds - begin.seconds) / (end - begin.seconds);
            let [there, predicted] = [
                seen.place.seen_from(begin.place),
                gait.place_at(phase).travel(),
            ]
            .map(parts);
            offs.push(Deviation {
                cycle,
                phase,
                off: [0, 1, 2].map(|axis| there[axis] - predicted[axis]),
            });
        }
    }
    offs
}

/// Computes the mean path within a cycle over walks. A part of the cycle with too few pictures has no point.
pub(crate) fn points(walks: &[Walk], gait: &Gait) -> Vec<Point> {
    let pictures = walks
        .iter()
        .map(|walk| walk.deviations.len() / walk.cycles.travels.len());
    let count = pictures.min().unwrap_or(0).clamp(1, PARTS);
    let mut points: Vec<Point> = (0..count)
        .filter_map(|part| point(walks, gait, part, count))
        .collect();
    // A few cycles give an inaccurate spread, so no part gets a smaller error than the average one.
    for axis in 0..3 {
        let squares = points.iter().map(|point| own(point.measured[axis]).powi(2));
        let usual = (squares.sum::<f64>() / points.len() as f64).sqrt();
        for point in &mut points {
            let mean = &mut point.measured[axis];
            mean.error = own(*mean).max(usual).hypot(mean.common);
        }
    }
    points
}

/// The part of an error that results from the spread of the cycles.
fn own(mean: Mean) -> f64 {
    (mean.error.powi(2) - mean.common.powi(2)).max(0.0).sqrt()
}

/// Computes the point of one of `count` parts of the cycle; `None` if too few pictures show that part.
fn point(walks: &[Walk], gait: &Gait, part: usize, count: usize) -> Option<Point> {
    let phase = (part as f64 + 0.5) / count as f64;
    let predicted = parts(gait.place_at(phase).travel());
    let pace = gait.pace(phase);
    let mean = |axis: usize| {
        let own = |walk: &Walk| {
            let cycles = in_cycles(walk, part, count, axis);
            // The common errors: of the cycle's beginning, of the scale, and of the camera.
            let late = pace[axis] * walk.cycles.begin_error / walk.cycles.period[0];
            let scale = if axis < 2 {
                predicted[axis] * walk.scale
            } else {
                0.0
            };
            let common = late.powi(2) + scale.powi(2) + phase.powi(2) * walk.scene_variances[axis];
            (cycles.len() > 1).then(|| (cycles, common.sqrt()))
        };
        let walks: Vec<_> = walks.iter().filter_map(own).collect();
        (!walks.is_empty()).then(|| {
            let mut mean = mean::mean_of_walks(&walks);
            mean.mean += predicted[axis];
            mean
        })
    };
    Some(Point {
        phase,
        measured: [mean(0)?, mean(1)?, mean(2)?],
        predicted,
    })
}

/// The mean deviation in a part of the cycle, for each cycle that has a picture of that part.
fn in_cycles(walk: &Walk, part: usize, count: usize, axis: usize) -> Vec<f64> {
    let is_here = |off: &&Deviation| (off.phase * count as f64) as usize == part;
    let cycle = |cycle: usize| {
        let here = walk.deviations.iter().filter(|off| off.cycle == cycle);
        let here: Vec<f64> = here.filter(is_here).map(|off| off.off[axis]).collect();
        (!here.is_empty()).then(|| here.iter().sum::<f64>() / here.len() as f64)
    };
    (0..walk.cycles.travels.len()).filter_map(cycle).collect()
}

fn parts(travel: Travel) -> [f64; 3] {
    [travel.forward, travel.left, travel.turn]
}
