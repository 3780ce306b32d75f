//! The start and the duration of a cycle, found from the movement within the cycle.
//!
//! The movement over a part of a cycle must fit the predicted movement. Only its variation counts, because its mean is
//! the quantity to be measured. If cycles of two, four or eight times the duration fit much better, the robot was
//! driven at another pace, or the video is in slow motion.

use crate::estimate::Estimate;
use crate::gait::{Gait, movement_in_mm, movement_length};
use crate::least_squares::{self, squared_norm};
use crate::path::{self, PathPoint};
use crate::video_error::VideoError;

/// Duration of each movement that is compared with the prediction, cycles.
const MOVEMENT_CYCLES: f64 = 0.25;
/// Smallest number of movements that a fit requires.
const MIN_MOVEMENT_COUNT: usize = 8;
/// Relative standard deviation of a cycle's duration: the board has a ceramic resonator.
const PERIOD_SIGMA: f64 = 0.003;
/// Largest relative error of a cycle's duration that a wrong frame rate causes, for example if 25 frames per second are
/// taken for 24 or 27.
const MAX_RATE_ERROR: f64 = 0.08;
/// Relative step of the search for a cycle's duration if the frame rate is wrong.
const SEARCH_STEP: f64 = 0.005;
/// Relative standard deviation of a duration found by that search.
const SEARCH_SIGMA: f64 = 0.01;
/// Number of cycle starts that are tried.
const START_COUNT: usize = 48;
/// Largest squared difference between measured and predicted movements of an accepted gait, as a fraction of the sum of
/// both movements' squares.
const MAX_MISFIT_FRACTION: f64 = 0.5;
/// Smallest squared difference between the movements of two consecutive cycles that counts as a change, as a fraction
/// of the mean of both movements' squares.
const MIN_CHANGE_FRACTION: f64 = 0.15;
/// Range of the scale of a prediction with which a path is compared: on a real floor, a robot may move half as far as
/// predicted, or twice as far. Every pace is compared with the same scales, so within this range a robot that moves
/// less far than predicted does not look like a robot at a slower pace.
pub(crate) const SCALE_RANGE: [f64; 2] = [0.5, 2.0];
/// Multiples of a cycle's duration with which the path is compared.
pub(crate) const PERIOD_MULTIPLES: [u32; 3] = [2, 4, 8];
/// Largest squared error with another cycle duration at which that duration is accepted, as a fraction of the squared
/// error with the expected duration. A multiple or half of the duration is accepted if its misfit is below this
/// fraction of the misfit with the expected duration, where a misfit above 1 counts as 1.
pub(crate) const MAX_MISFIT_RATIO: f64 = 0.3;

/// Largest misfit of an accepted gait: the misfit of a robot that moves a third as far, or four times as far, as
/// predicted.
pub(crate) const MAX_MISFIT: f64 = 0.25;

/// The timing of a walk's cycles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CycleTiming {
    /// The start of a cycle, s.
    pub start: Estimate,
    /// The duration of a cycle, s.
    pub period: Estimate,
}

/// The robot's movements over a fixed part of a cycle, one movement from each frame.
#[derive(Debug, Clone)]
pub(crate) struct Movements {
    /// Duration of each movement, s.
    duration: f64,
    /// For each movement, the time of the frame at which it begins, s, and its components from [`movement_in_mm`].
    movements: Vec<(f64, [f64; 3])>,
}

impl Movements {
    /// Computes the movements along a path whose cycles last `period` seconds.
    pub(crate) fn from_path(path: &[PathPoint], period: f64) -> Self {
        let duration = MOVEMENT_CYCLES * period;
        let movement_from = |point: &PathPoint| {
            let later_pose = path::interpolate_at(path, point.seconds + duration)?;
            let movement = movement_in_mm(later_pose.travel_from(point.pose));
            Some((point.seconds, movement))
        };
        Self {
            duration,
            movements: path.iter().filter_map(movement_from).collect(),
        }
    }

    /// True if there are too few movements for a fit.
    pub(crate) fn are_too_few(&self) -> bool {
        self.movements.len() < MIN_MOVEMENT_COUNT
    }

    /// Finds the start and the duration of a cycle.
    ///
    /// # Errors
    /// Fails if the movement shows another gait or pace.
    pub(crate) fn fit_timing(&self, gait: &Gait) -> Result<CycleTiming, VideoError> {
        let centred_error =
            |start: f64, period: f64| squared_norm(&self.centred_residuals(gait, start, period));
        let (mut min_centred_error, mut start, mut period) =
            self.minimise(gait.period, &likely_periods(gait), centred_error);
        let (mut expected_period, mut relative_sigma) = (gait.period, PERIOD_SIGMA);
        // If the frame rate is wrong, only the path itself gives the duration of a cycle.
        let (wide_error, wide_start, wide_period) =
            self.minimise(gait.period, &wide_periods(gait), centred_error);
        if wide_error < MAX_MISFIT_RATIO * min_centred_error {
            (min_centred_error, start, period) = (wide_error, wide_start, wide_period);
            (expected_period, relative_sigma) = (period, SEARCH_SIGMA);
        }
        let squared_error = squared_norm(&self.residuals(gait, start, period));
        let (slow_misfit, multiple) = self.misfit_at_best_multiple(gait);
        if slow_misfit < MAX_MISFIT_RATIO * self.misfit_at(gait, start, period).min(1.0) {
            return Err(VideoError::WrongPace { ratio: multiple });
        }
        // At twice the given pace, two cycles look like one.
        let half_period = gait.period / 2.0;
        let fast_misfit = self.compute_misfit_with_periods(gait, half_period, &[half_period]);
        if fast_misfit < MAX_MISFIT_RATIO * self.compute_misfit(gait).min(1.0) {
            return Err(VideoError::GaitMismatch {
                period: gait.period,
            });
        }
        let squares = |(time, measured): &(f64, [f64; 3])| {
            let phase = (time - start) / period;
            let predicted = gait.movement_between(phase, phase + self.duration / period);
            movement_length(*measured).powi(2) + movement_length(predicted).powi(2)
        };
        if squared_error > MAX_MISFIT_FRACTION * self.movements.iter().map(squares).sum::<f64>() {
            return Err(VideoError::GaitMismatch {
                period: gait.period,
            });
        }
        let variance = min_centred_error / (3 * self.movements.len()) as f64;
        let sigma = variance.sqrt().max(1e-3);
        let model = |parameters: &[f64]| {
            let mut residuals = self.centred_residuals(gait, parameters[0], parameters[1]);
            residuals.iter_mut().for_each(|value| *value /= sigma);
            residuals.push((parameters[1] / expected_period - 1.0) / relative_sigma);
            // Keeps the start near its first value if the movement does not determine it.
            residuals.push((parameters[0] - start) / gait.period);
            residuals
        };
        let prior_sigmas = [gait.period, relative_sigma * expected_period];
        let overlap_count = self.overlap_count();
        let [start, period] = match least_squares::fit(&[start, period], model) {
            Some(fit) => [0, 1].map(|i: usize| {
                // The covariance assumes independent residuals. The movements overlap, so their part of the variance is
                // larger; the last two residuals are independent.
                let prior_terms =
                    [0, 1].map(|j: usize| (fit.covariance[(i, j)] / prior_sigmas[j]).powi(2));
                let variance = overlap_count * fit.covariance[(i, i)]
                    - (overlap_count - 1.0) * prior_terms.iter().sum::<f64>();
                Estimate::new(fit.parameters[i], variance.sqrt())
            }),
            None => [
                Estimate::new(start, gait.period / START_COUNT as f64),
                Estimate::new(period, relative_sigma * period),
            ],
        };
        Ok(CycleTiming { start, period })
    }

    /// Computes the misfit of a gait: the squared difference between measured and predicted movements, as a fraction of
    /// the measured movements' squares, for the cycle start, the duration and the scale of the prediction that fit
    /// best.
    pub(crate) fn compute_misfit(&self, gait: &Gait) -> f64 {
        self.compute_misfit_with_periods(gait, gait.period, &likely_periods(gait))
    }

    /// Computes the misfit of a gait with cycles of several times their usual duration, for the cycle start and the
    /// scale of the prediction that fit best. Returns the smallest misfit and its multiple of the duration.
    pub(crate) fn misfit_at_best_multiple(&self, gait: &Gait) -> (f64, u32) {
        let misfits = PERIOD_MULTIPLES.map(|multiple| {
            let period = f64::from(multiple) * gait.period;
            let misfit = self.compute_misfit_with_periods(gait, period, &[period]);
            (misfit, multiple)
        });
        let best = misfits.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        best.unwrap_or((f64::INFINITY, 1))
    }

    /// Computes the misfit of a gait for cycle starts within `period`, cycle durations in `periods`, and scales of the
    /// prediction in [`SCALE_RANGE`].
    fn compute_misfit_with_periods(&self, gait: &Gait, period: f64, periods: &[f64]) -> f64 {
        let misfit = |start: f64, period: f64| self.misfit_at(gait, start, period);
        self.minimise(period, periods, misfit).0
    }

    /// Computes the misfit of a gait for a cycle start, a cycle duration, and the scale of the prediction in
    /// [`SCALE_RANGE`] that fits best.
    fn misfit_at(&self, gait: &Gait, start: f64, period: f64) -> f64 {
        let (mut products, mut squares) = (0.0, 0.0);
        for (time, measured) in &self.movements {
            let phase = (time - start) / period;
            let predicted = gait.movement_between(phase, phase + self.duration / period);
            let axis_products = [0, 1, 2].map(|axis| measured[axis] * predicted[axis]);
            products += axis_products.iter().sum::<f64>();
            squares += movement_length(predicted).powi(2);
        }
        let scale = (products / squares).clamp(SCALE_RANGE[0], SCALE_RANGE[1]);
        1.0 - scale * (2.0 * products - scale * squares) / self.sum_of_squares()
    }

    /// Returns the number of movements that begin during one movement, at least 1. As these movements overlap, their
    /// deviations from the prediction are alike.
    fn overlap_count(&self) -> f64 {
        let count = self.movements.len();
        let seconds = self.movements[count - 1].0 - self.movements[0].0;
        (count as f64 * self.duration / seconds).max(1.0)
    }

    /// Computes the sum of the measured movements' squares.
    fn sum_of_squares(&self) -> f64 {
        let square = |(_, measured): &(f64, [f64; 3])| movement_length(*measured).powi(2);
        self.movements.iter().map(square).sum()
    }

    /// Finds the first cycle whose movement differs from the next cycle's, and returns its start, s; `None` if all
    /// cycles are alike.
    pub(crate) fn find_change(&self, period: f64) -> Option<f64> {
        let first = self.movements.first()?.0;
        let last = self.movements.last()?.0;
        let cycle_count = ((last - first) / period) as usize;
        let mut starts = (1..cycle_count).map(|i| first + (i - 1) as f64 * period);
        starts.find(|start| {
            let is_in_cycle =
                |(time, _): &&(f64, [f64; 3])| (*start..start + period).contains(time);
            let (mut difference, mut mean_squares) = (0.0, 0.0);
            for (time, movement) in self.movements.iter().filter(is_in_cycle) {
                if let Some(next_movement) = self.movement_at(time + period) {
                    let change = [0, 1, 2].map(|axis| next_movement[axis] - movement[axis]);
                    difference += movement_length(change).powi(2);
                    mean_squares += (movement_length(next_movement).powi(2)
                        + movement_length(*movement).powi(2))
                        / 2.0;
                }
            }
            difference > MIN_CHANGE_FRACTION * mean_squares
        })
    }

    /// Interpolates the movement that begins at a time between two frames; `None` outside the video.
    fn movement_at(&self, seconds: f64) -> Option<[f64; 3]> {
        let next_index = self.movements.partition_point(|(time, _)| *time < seconds);
        let (b, later) = self.movements.get(next_index)?;
        let (a, earlier) = self.movements.get(next_index.checked_sub(1)?)?;
        let fraction = (seconds - a) / (b - a);
        Some([0, 1, 2].map(|axis| earlier[axis] + fraction * (later[axis] - earlier[axis])))
    }

    /// Minimises a function of a cycle's start and duration, and returns its value, the start and the duration. Tries
    /// starts within a cycle of duration `period`, each with all durations in `periods`.
    fn minimise(
        &self,
        period: f64,
        periods: &[f64],
        function: impl Fn(f64, f64) -> f64,
    ) -> (f64, f64, f64) {
        let first_time = self.movements[0].0;
        let middle_cycle =
            ((self.movements[self.movements.len() / 2].0 - first_time) / period).floor();
        let mut best = (f64::INFINITY, first_time, period);
        for i in 0..START_COUNT {
            let start = first_time + period * i as f64 / START_COUNT as f64;
            for &tried_period in periods {
                // The start depends on the duration, so that the phase in the middle of the video stays the same.
                let start = start + middle_cycle * (period - tried_period);
                let value = function(start, tried_period);
                if value < best.0 {
                    best = (value, start, tried_period);
                }
            }
        }
        best
    }

    /// Computes the measured minus the predicted movements, axis by axis.
    fn residuals(&self, gait: &Gait, start: f64, period: f64) -> Vec<f64> {
        let residual = |(time, measured): &(f64, [f64; 3])| {
            let phase = (time - start) / period;
            let predicted = gait.movement_between(phase, phase + self.duration / period);
            [0, 1, 2].map(|axis| measured[axis] - predicted[axis])
        };
        self.movements.iter().flat_map(residual).collect()
    }

    /// Computes the [`Movements::residuals`] minus their mean on each axis, so that only the variation within a cycle
    /// counts.
    fn centred_residuals(&self, gait: &Gait, start: f64, period: f64) -> Vec<f64> {
        let mut residuals = self.residuals(gait, start, period);
        for axis in 0..3 {
            let on_axis = residuals.iter().skip(axis).step_by(3);
            let mean = on_axis.sum::<f64>() / self.movements.len() as f64;
            for residual in residuals.iter_mut().skip(axis).step_by(3) {
                *residual -= mean;
            }
        }
        residuals
    }
}

/// Lists the cycle durations that are tried if the frame rate may be wrong.
fn wide_periods(gait: &Gait) -> Vec<f64> {
    let step_count = (MAX_RATE_ERROR / SEARCH_STEP) as i32;
    let period_at = |index: i32| gait.period * (1.0 + SEARCH_STEP * f64::from(index));
    (-step_count..=step_count).map(period_at).collect()
}

/// Lists the cycle durations that are tried first.
fn likely_periods(gait: &Gait) -> [f64; 5] {
    [-2.0, -1.0, 0.0, 1.0, 2.0].map(|sigmas| gait.period * (1.0 + PERIOD_SIGMA * sigmas))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fastrand::Rng;
    use lizard_contact::BodyPose;
    use lizard_studio::walk::{REST_S, Variation, Walk, paper_gait};

    #[test]
    fn the_true_period_lies_within_two_standard_errors_in_at_least_30_of_40_uneven_walks() {
        const CYCLE_COUNT: usize = 6;
        const FRAMES_PER_S: f64 = 30.0;
        let true_gait = paper_gait("walk");
        let gait = Gait {
            period: true_gait.period,
            path: true_gait.path.clone(),
        };
        let variation = Variation {
            cycle_deviation: [0.4, 0.4, 0.01],
            clock_deviation: 0.003,
            ruler_deviation: 0.0,
        };
        let mut rng = Rng::with_seed(1);
        let hits = (0..40).filter(|_| {
            let walk = Walk::new(&true_gait, [0.0; 3], CYCLE_COUNT, variation, &mut rng);
            let true_period = (walk.duration_s() - 2.0 * REST_S) / CYCLE_COUNT as f64;
            let point_at = |i: usize| {
                let seconds = REST_S + i as f64 / FRAMES_PER_S;
                let [forward, left, heading] = walk.pose_at(seconds);
                let pose = BodyPose {
                    forward,
                    left,
                    heading,
                };
                PathPoint { seconds, pose }
            };
            let frame_count = (true_period * CYCLE_COUNT as f64 * FRAMES_PER_S) as usize;
            let path: Vec<PathPoint> = (0..frame_count).map(point_at).collect();
            let timing = Movements::from_path(&path, gait.period).fit_timing(&gait);
            let period = timing.expect("the path shows the gait").period;
            (period.value - true_period).abs() < 2.0 * period.standard_error
        });
        let hit_count = hits.count();
        // With other seeds, 32 to 40. It would be about 21 if the overlap of the movements did not enlarge the error.
        assert!(hit_count >= 30, "{hit_count} of 40 walks");
    }
}
