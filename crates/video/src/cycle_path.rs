//! The mean path within a cycle, compared with the predicted path.
//!
//! Frames are taken at any phase, and the path between two frames is not a straight line. Therefore the pose in each
//! frame is compared with the predicted pose at the same phase. The differences change slowly within a cycle, so they
//! are averaged over bins of the phase.

use crate::cycles::Cycles;
use crate::gait::Gait;
use crate::mean::{self, Mean, WalkValues};
use crate::path::PathPoint;
use crate::walk::{Deviation, Walk, components};

/// Largest number of bins of the phase; each bin should have at least one frame of every cycle.
const MAX_BIN_COUNT: usize = 24;

/// A point of the mean path within a cycle, relative to the cycle's start: forward and left, mm, and turn, deg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclePoint {
    /// Phase, 0 to 1: the centre of the bin over which the point is averaged.
    pub phase: f64,
    /// The measured pose.
    pub measured: [Mean; 3],
    /// The predicted pose.
    pub predicted: [f64; 3],
}

impl CyclePoint {
    /// Returns the measured minus the predicted pose, in standard errors: forward, left, turn.
    pub fn standardised_differences(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let mean = self.measured[axis];
            (mean.value - self.predicted[axis]) / mean.standard_error.max(1e-6)
        })
    }
}

/// Computes the deviation of each frame from the predicted path within a cycle.
pub(crate) fn compute_deviations(
    path: &[PathPoint],
    cycles: &Cycles,
    gait: &Gait,
) -> Vec<Deviation> {
    let mut deviations = Vec::new();
    for (cycle_index, pair) in cycles.starts.windows(2).enumerate() {
        let (start, end) = (pair[0], pair[1].seconds);
        let is_inside = |point: &&PathPoint| (start.seconds..end).contains(&point.seconds);
        for point in path.iter().filter(is_inside) {
            let phase = (point.seconds - start.seconds) / (end - start.seconds);
            let measured = components(point.pose.travel_from(start.pose));
            let predicted = components(gait.pose_at(phase).travel());
            deviations.push(Deviation {
                cycle_index,
                phase,
                offset: [0, 1, 2].map(|axis| measured[axis] - predicted[axis]),
            });
        }
    }
    deviations
}

/// Computes the mean path within a cycle over several walks. A bin with too few frames has no point.
pub(crate) fn compute_points(walks: &[Walk], gait: &Gait) -> Vec<CyclePoint> {
    let frames_per_cycle = |walk: &Walk| walk.deviations.len() / walk.cycles.travels.len();
    let min_count = walks.iter().map(frames_per_cycle).min();
    let bin_count = min_count.unwrap_or(0).clamp(1, MAX_BIN_COUNT);
    let point_of_bin = |bin_index| compute_point(walks, gait, bin_index, bin_count);
    let mut points: Vec<CyclePoint> = (0..bin_count).filter_map(point_of_bin).collect();
    // The spread of a few cycles is inaccurate, so no bin gets an error below the average.
    for axis in 0..3 {
        let square = |point: &CyclePoint| random_error(point.measured[axis]).powi(2);
        let mean_square = points.iter().map(square).sum::<f64>() / points.len() as f64;
        for point in &mut points {
            let mean = &mut point.measured[axis];
            let error = random_error(*mean).max(mean_square.sqrt());
            mean.standard_error = error.hypot(mean.systematic_error);
        }
    }
    points
}

/// Returns the part of a mean's standard error that results from the spread of the cycles.
fn random_error(mean: Mean) -> f64 {
    let variance = mean.standard_error.powi(2) - mean.systematic_error.powi(2);
    variance.max(0.0).sqrt()
}

/// Computes the point for one of `bin_count` equal bins of the phase; `None` if the bin has too few frames.
fn compute_point(
    walks: &[Walk],
    gait: &Gait,
    bin_index: usize,
    bin_count: usize,
) -> Option<CyclePoint> {
    let phase = (bin_index as f64 + 0.5) / bin_count as f64;
    let predicted = components(gait.pose_at(phase).travel());
    let rate = gait.rate_at(phase);
    let compute_mean = |axis: usize| {
        let walk_values = |walk: &Walk| {
            let cycles = means_by_cycle(walk, bin_index, bin_count, axis);
            // The errors that all cycles have in common are those of the clock, the scale and the camera.
            let clock_error = rate[axis] * walk.cycles.start_error / walk.cycles.period.value;
            let scale_error = match axis {
                0 | 1 => predicted[axis] * walk.scale_error,
                _ => 0.0,
            };
            let systematic_variance = clock_error.powi(2)
                + scale_error.powi(2)
                + phase.powi(2) * walk.scene_variances[axis];
            (cycles.len() > 1).then(|| WalkValues {
                cycles,
                systematic_error: systematic_variance.sqrt(),
            })
        };
        let walks: Vec<_> = walks.iter().filter_map(walk_values).collect();
        (!walks.is_empty()).then(|| {
            let mut mean = mean::compute_mean(&walks);
            mean.value += predicted[axis];
            mean
        })
    };
    Some(CyclePoint {
        phase,
        measured: [compute_mean(0)?, compute_mean(1)?, compute_mean(2)?],
        predicted,
    })
}

/// Computes the mean deviation in a bin of the phase for each cycle that has a frame in that bin.
fn means_by_cycle(walk: &Walk, bin_index: usize, bin_count: usize, axis: usize) -> Vec<f64> {
    let cycle_mean = |index: usize| {
        let is_selected = |deviation: &&Deviation| {
            let bin = (deviation.phase * bin_count as f64) as usize;
            deviation.cycle_index == index && bin == bin_index
        };
        let selected = walk.deviations.iter().filter(is_selected);
        let values: Vec<f64> = selected.map(|deviation| deviation.offset[axis]).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    let cycle_count = walk.cycles.travels.len();
    (0..cycle_count).filter_map(cycle_mean).collect()
}
