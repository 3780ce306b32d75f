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
const MAX_PARTS: usize = 24;

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
    let mut deviations = Vec::new();
    for (cycle, pair) in cycles.begins.windows(2).enumerate() {
        let (begin, end) = (pair[0], pair[1].seconds);
        let is_inside = |point: &&PathPoint| (begin.seconds..end).contains(&point.seconds);
        for point in path.iter().filter(is_inside) {
            let phase = (point.seconds - begin.seconds) / (end - begin.seconds);
            let [measured, predicted] = [
                point.place.seen_from(begin.place),
                gait.place_at(phase).travel(),
            ]
            .map(components);
            deviations.push(Deviation {
                cycle,
                phase,
                off: [0, 1, 2].map(|axis| measured[axis] - predicted[axis]),
            });
        }
    }
    deviations
}

/// Computes the mean path within a cycle over walks. A part of the cycle with too few pictures has no point.
pub(crate) fn points(walks: &[Walk], gait: &Gait) -> Vec<Point> {
    let pictures = walks
        .iter()
        .map(|walk| walk.deviations.len() / walk.cycles.travels.len());
    let count = pictures.min().unwrap_or(0).clamp(1, MAX_PARTS);
    let mut points: Vec<Point> = (0..count)
        .filter_map(|part_index| compute_point(walks, gait, part_index, count))
        .collect();
    // A few cycles give an inaccurate spread, so no part gets a smaller error than the average one.
    for axis in 0..3 {
        let squares = points
            .iter()
            .map(|point| spread_error(point.measured[axis]).powi(2));
        let typical_error = (squares.sum::<f64>() / points.len() as f64).sqrt();
        for point in &mut points {
            let mean = &mut point.measured[axis];
            mean.error = spread_error(*mean).max(typical_error).hypot(mean.common);
        }
    }
    points
}

/// The part of an error that results from the spread of the cycles.
fn spread_error(mean: Mean) -> f64 {
    (mean.error.powi(2) - mean.common.powi(2)).max(0.0).sqrt()
}

/// Computes the point of one of `count` parts of the cycle; `None` if too few pictures show that part.
fn compute_point(walks: &[Walk], gait: &Gait, part_index: usize, count: usize) -> Option<Point> {
    let phase = (part_index as f64 + 0.5) / count as f64;
    let predicted = components(gait.place_at(phase).travel());
    let pace = gait.pace(phase);
    let mean_of = |axis: usize| {
        let cycles_of = |walk: &Walk| {
            let cycles = mean_by_cycle(walk, part_index, count, axis);
            // The common errors: of the cycle's beginning, of the scale, and of the camera.
            let clock_error = pace[axis] * walk.cycles.begin_error / walk.cycles.period[0];
            let scale = if axis < 2 {
                predicted[axis] * walk.scale
            } else {
                0.0
            };
            let common =
                clock_error.powi(2) + scale.powi(2) + phase.powi(2) * walk.scene_variances[axis];
            (cycles.len() > 1).then(|| (cycles, common.sqrt()))
        };
        let walks: Vec<_> = walks.iter().filter_map(cycles_of).collect();
        (!walks.is_empty()).then(|| {
            let mut mean = mean::mean_of_walks(&walks);
            mean.mean += predicted[axis];
            mean
        })
    };
    Some(Point {
        phase,
        measured: [mean_of(0)?, mean_of(1)?, mean_of(2)?],
        predicted,
    })
}

/// The mean deviation in a part of the cycle, for each cycle that has a picture of that part.
fn mean_by_cycle(walk: &Walk, part_index: usize, count: usize, axis: usize) -> Vec<f64> {
    let is_in_part =
        |deviation: &&Deviation| (deviation.phase * count as f64) as usize == part_index;
    let mean_of_cycle = |cycle: usize| {
        let values = walk
            .deviations
            .iter()
            .filter(|deviation| deviation.cycle == cycle);
        let values: Vec<f64> = values
            .filter(is_in_part)
            .map(|deviation| deviation.off[axis])
            .collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    (0..walk.cycles.travels.len())
        .filter_map(mean_of_cycle)
        .collect()
}

fn components(travel: Travel) -> [f64; 3] {
    [travel.forward, travel.left, travel.turn]
}
