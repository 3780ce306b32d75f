//! The mean path within a cycle, compared with the predicted one.
//!
//! Pictures are taken at any phase, and the path between two of them is not a straight line. So the place in each
//! picture is compared with the predicted place at the same phase. The differences change slowly within a cycle, and
//! are averaged over parts of it.

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
pub struct CyclePoint {
    /// Phase, 0 to 1: the middle of the part of the cycle over which the point is averaged.
    pub phase: f64,
    /// The measured place, with its spread and error.
    pub measured: [Mean; 3],
    /// The predicted place.
    pub predicted: [f64; 3],
}

impl CyclePoint {
    /// The measured place minus the predicted one, in standard errors: forward, left, turn.
    pub fn standardised_differences(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let Mean {
                value: mean, error, ..
            } = self.measured[axis];
            (mean - self.predicted[axis]) / error.max(1e-6)
        })
    }
}

/// Computes the deviation of each picture within a cycle from the predicted path.
pub(crate) fn compute_deviations(
    path: &[PathPoint],
    cycles: &Cycles,
    gait: &Gait,
) -> Vec<Deviation> {
    let mut deviations = Vec::new();
    for (cycle, pair) in cycles.beginnings.windows(2).enumerate() {
        let (begin, end) = (pair[0], pair[1].seconds);
        let is_inside = |point: &&PathPoint| (begin.seconds..end).contains(&point.seconds);
        for point in path.iter().filter(is_inside) {
            let phase = (point.seconds - begin.seconds) / (end - begin.seconds);
            let [measured, predicted] = [
                point.place.travel_from(begin.place),
                gait.place_at(phase).travel(),
            ]
            .map(components);
            deviations.push(Deviation {
                cycle,
                phase,
                offset: [0, 1, 2].map(|axis| measured[axis] - predicted[axis]),
            });
        }
    }
    deviations
}

/// Computes the mean path within a cycle over walks. A part of the cycle with too few pictures has no point.
pub(crate) fn compute_points(walks: &[Walk], gait: &Gait) -> Vec<CyclePoint> {
    let pictures_per_cycle = walks
        .iter()
        .map(|walk| walk.deviations.len() / walk.cycles.travels.len());
    let part_count = pictures_per_cycle.min().unwrap_or(0).clamp(1, MAX_PARTS);
    let mut points: Vec<CyclePoint> = (0..part_count)
        .filter_map(|part_index| compute_point(walks, gait, part_index, part_count))
        .collect();
    // A few cycles give an inaccurate spread, so no part gets a smaller error than the average one.
    for axis in 0..3 {
        let squares = points
            .iter()
            .map(|point| spread_error(point.measured[axis]).powi(2));
        let typical_error = (squares.sum::<f64>() / points.len() as f64).sqrt();
        for point in &mut points {
            let mean = &mut point.measured[axis];
            mean.error = spread_error(*mean)
                .max(typical_error)
                .hypot(mean.common_error);
        }
    }
    points
}

/// The part of an error that results from the spread of the cycles.
fn spread_error(mean: Mean) -> f64 {
    (mean.error.powi(2) - mean.common_error.powi(2))
        .max(0.0)
        .sqrt()
}

/// Computes the point of one of `part_count` equal parts of the cycle; `None` if too few pictures show that part.
fn compute_point(
    walks: &[Walk],
    gait: &Gait,
    part_index: usize,
    part_count: usize,
) -> Option<CyclePoint> {
    let phase = (part_index as f64 + 0.5) / part_count as f64;
    let predicted = components(gait.place_at(phase).travel());
    let rate = gait.rate_at(phase);
    let mean_of = |axis: usize| {
        let cycles_of = |walk: &Walk| {
            let cycles = mean_by_cycle(walk, part_index, part_count, axis);
            // The errors that all cycles share: of the cycle's beginning, of the scale, and of the camera.
            let clock_error = rate[axis] * walk.cycles.beginning_error / walk.cycles.period[0];
            let scale_error = if axis < 2 {
                predicted[axis] * walk.scale_error
            } else {
                0.0
            };
            let common_variance = clock_error.powi(2)
                + scale_error.powi(2)
                + phase.powi(2) * walk.scene_variances[axis];
            (cycles.len() > 1).then(|| (cycles, common_variance.sqrt()))
        };
        let walks: Vec<_> = walks.iter().filter_map(cycles_of).collect();
        (!walks.is_empty()).then(|| {
            let mut mean = mean::mean_of_walks(&walks);
            mean.value += predicted[axis];
            mean
        })
    };
    Some(CyclePoint {
        phase,
        measured: [mean_of(0)?, mean_of(1)?, mean_of(2)?],
        predicted,
    })
}

/// The mean deviation in a part of the cycle, for each cycle that has a picture of that part.
fn mean_by_cycle(walk: &Walk, part_index: usize, part_count: usize, axis: usize) -> Vec<f64> {
    let is_in_part =
        |deviation: &&Deviation| (deviation.phase * part_count as f64) as usize == part_index;
    let mean_of_cycle = |cycle: usize| {
        let values = walk
            .deviations
            .iter()
            .filter(|deviation| deviation.cycle == cycle);
        let values: Vec<f64> = values
            .filter(is_in_part)
            .map(|deviation| deviation.offset[axis])
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
