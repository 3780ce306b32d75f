//! The start and the duration of a cycle, found from the movement within it.
//!
//! The movement over a part of a cycle must fit the predicted one. Only its variation counts, because its mean is the
//! quantity to be measured. If the movement fits cycles that take twice as long or longer much better, the robot was
//! driven at another pace, or the film is in slow motion.

use crate::figure::Figure;
use crate::gait::{Gait, movement_in_mm, movement_length};
use crate::least_squares;
use crate::path::{self, PathPoint};
use crate::trouble::Trouble;

/// Duration of each movement that is compared with the prediction, in cycles.
const MOVEMENT_CYCLES: f64 = 0.25;
/// Smallest number of movements.
const MIN_MOVEMENTS: usize = 8;
/// Standard deviation of a cycle's duration, as a share: the board has a ceramic resonator.
const PERIOD_SIGMA: f64 = 0.003;
/// Largest share by which a wrong picture rate makes a cycle longer or shorter, for example if 25 pictures per second
/// are taken for 24 or 27.
const MAX_RATE_ERROR: f64 = 0.08;
/// Step of the search for the duration of a cycle if the picture rate is wrong, as a share.
const SEARCH_STEP: f64 = 0.005;
/// Standard deviation of a duration found by that search, as a share.
const SEARCH_SIGMA: f64 = 0.01;
/// Number of cycle starts that are tried.
const START_COUNT: usize = 48;
/// Largest squared difference between measured and predicted movements at which the gait is accepted, as a share of
/// the sum of the squares of both.
const MAX_MISFIT_SHARE: f64 = 0.5;
/// Smallest squared difference at which the movements of two consecutive cycles count as different, as a share of the
/// mean of the squares of both.
const MIN_CHANGE_SHARE: f64 = 0.15;
/// Multiples of a cycle's duration that are tried.
const PERIOD_MULTIPLES: [u32; 3] = [2, 4, 8];
/// Largest misfit with another duration of a cycle, as a share of the misfit with the expected duration, at which the
/// other duration is accepted. The misfit with a multiple of the duration must also be below this share of the sum of
/// squares of the measured movements.
const MAX_MISFIT_RATIO: f64 = 0.3;

/// The timing of a walk's cycles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Clock {
    /// The start of a cycle, s.
    pub start: Figure,
    /// The duration of a cycle, s.
    pub period: Figure,
}

/// The robot's movements over a fixed part of a cycle, one movement from each picture.
#[derive(Debug, Clone)]
pub(crate) struct Movements {
    /// Duration of each movement, s.
    duration: f64,
    /// The time of the picture at which each movement begins, s, and the movement as [`movement_in_mm`] gives it.
    movements: Vec<(f64, [f64; 3])>,
}

impl Movements {
    /// Computes the movements along a path; the robot's cycles last `period` seconds.
    pub(crate) fn from_path(path: &[PathPoint], period: f64) -> Self {
        let duration = MOVEMENT_CYCLES * period;
        let movement_from = |point: &PathPoint| {
            let later_place = path::interpolate_at(path, point.seconds + duration)?;
            Some((
                point.seconds,
                movement_in_mm(later_place.travel_from(point.place)),
            ))
        };
        Self {
            duration,
            movements: path.iter().filter_map(movement_from).collect(),
        }
    }

    /// True if there are too few movements for a fit.
    pub(crate) fn are_too_few(&self) -> bool {
        self.movements.len() < MIN_MOVEMENTS
    }

    /// Finds the start and the duration of a cycle.
    ///
    /// # Errors
    /// Fails if the movement shows another gait or pace.
    pub(crate) fn fit_clock(&self, gait: &Gait) -> Result<Clock, Trouble> {
        let periods = likely_periods(gait);
        let centred_misfit =
            |start: f64, period: f64| squared_norm(&self.centred_residuals(gait, start, period));
        let (mut min_misfit, mut start, mut period) =
            self.minimise(gait.period, &periods, centred_misfit);
        let (mut expected_period, mut relative_sigma) = (gait.period, PERIOD_SIGMA);
        // If the picture rate is wrong, only the path itself gives the duration of a cycle.
        let (wide_misfit, wide_start, wide_period) =
            self.minimise(gait.period, &wide_periods(gait), centred_misfit);
        if wide_misfit < MAX_MISFIT_RATIO * min_misfit {
            (min_misfit, start, period) = (wide_misfit, wide_start, wide_period);
            (expected_period, relative_sigma) = (period, SEARCH_SIGMA);
        }
        let misfit = squared_norm(&self.residuals(gait, start, period));
        let (slow_misfit, multiple) = self.misfit_at_best_multiple(gait);
        if slow_misfit < MAX_MISFIT_RATIO * (misfit / self.sum_of_squares()).min(1.0) {
            return Err(Trouble::WrongPace { ratio: multiple });
        }
        let squares_of_both = |(time, measured): &(f64, [f64; 3])| {
            let phase = (time - start) / period;
            let predicted = gait.movement_between(phase, phase + self.duration / period);
            movement_length(*measured).powi(2) + movement_length(predicted).powi(2)
        };
        if misfit > MAX_MISFIT_SHARE * self.movements.iter().map(squares_of_both).sum::<f64>() {
            return Err(Trouble::GaitMismatch {
                period: gait.period,
            });
        }
        let sigma = (min_misfit / (3 * self.movements.len()) as f64)
            .sqrt()
            .max(1e-3);
        let model = |parameters: &[f64]| {
            let mut residuals = self.centred_residuals(gait, parameters[0], parameters[1]);
            residuals.iter_mut().for_each(|value| *value /= sigma);
            residuals.push((parameters[1] / expected_period - 1.0) / relative_sigma);
            // Keeps the start near its first value if nothing within a cycle determines it.
            residuals.push((parameters[0] - start) / gait.period);
            residuals
        };
        Ok(match least_squares::fit(&[start, period], model) {
            Some(fit) => Clock {
                start: Figure {
                    value: fit.parameters[0],
                    error: fit.covariance[(0, 0)].sqrt(),
                },
                period: Figure {
                    value: fit.parameters[1],
                    error: fit.covariance[(1, 1)].sqrt(),
                },
            },
            None => Clock {
                start: Figure {
                    value: start,
                    error: gait.period / START_COUNT as f64,
                },
                period: Figure {
                    value: period,
                    error: relative_sigma * period,
                },
            },
        })
    }

    /// The misfit of a gait: the squared difference between measured and predicted movements, as a share of the
    /// measured movements' squares, with the start and duration of a cycle that fit best.
    pub(crate) fn misfit(&self, gait: &Gait) -> f64 {
        let misfit_of =
            |start: f64, period: f64| squared_norm(&self.residuals(gait, start, period));
        self.minimise(gait.period, &likely_periods(gait), misfit_of)
            .0
            / self.sum_of_squares()
    }

    /// The misfit of a gait whose cycles take a multiple of their usual duration, for the multiple that fits best, and
    /// that multiple.
    pub(crate) fn misfit_at_best_multiple(&self, gait: &Gait) -> (f64, u32) {
        let misfit_of =
            |start: f64, period: f64| squared_norm(&self.residuals(gait, start, period));
        let misfits = PERIOD_MULTIPLES.map(|multiple| {
            let period = f64::from(multiple) * gait.period;
            (
                self.minimise(period, &[period], misfit_of).0 / self.sum_of_squares(),
                multiple,
            )
        });
        let best = misfits.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        best.unwrap_or((f64::INFINITY, 1))
    }

    /// The sum of the squares of the measured movements.
    fn sum_of_squares(&self) -> f64 {
        self.movements
            .iter()
            .map(|(_, measured)| movement_length(*measured).powi(2))
            .sum()
    }

    /// Finds the first cycle whose movement differs from that of the next cycle, and returns its start, s; `None` if
    /// all cycles are alike.
    pub(crate) fn find_change(&self, period: f64) -> Option<f64> {
        let first = self.movements.first()?.0;
        let last = self.movements.last()?.0;
        let cycles = ((last - first) / period) as usize;
        let mut starts = (1..cycles).map(|i| first + (i - 1) as f64 * period);
        starts.find(|start| {
            let is_in_cycle =
                |(time, _): &&(f64, [f64; 3])| (*start..start + period).contains(time);
            let (mut difference, mut mean_squares) = (0.0, 0.0);
            for (time, movement) in self.movements.iter().filter(is_in_cycle) {
                if let Some(next_movement) = self.movement_at(time + period) {
                    difference +=
                        movement_length([0, 1, 2].map(|axis| next_movement[axis] - movement[axis]))
                            .powi(2);
                    mean_squares += (movement_length(next_movement).powi(2)
                        + movement_length(*movement).powi(2))
                        / 2.0;
                }
            }
            difference > MIN_CHANGE_SHARE * mean_squares
        })
    }

    /// The movement that begins at a time between two pictures, interpolated; `None` outside the film.
    fn movement_at(&self, seconds: f64) -> Option<[f64; 3]> {
        let next_index = self.movements.partition_point(|(time, _)| *time < seconds);
        let (b, later) = self.movements.get(next_index)?;
        let (a, earlier) = self.movements.get(next_index.checked_sub(1)?)?;
        let share = (seconds - a) / (b - a);
        Some([0, 1, 2].map(|axis| earlier[axis] + share * (later[axis] - earlier[axis])))
    }

    /// Minimises a function of a cycle's start and duration; returns its value, the start and the duration. Tries
    /// starts within a cycle of duration `period`, each with all durations `periods`.
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
                // The start moves with the duration, so that the phase in the middle of the film stays the same.
                let start = start + middle_cycle * (period - tried_period);
                let value = function(start, tried_period);
                if value < best.0 {
                    best = (value, start, tried_period);
                }
            }
        }
        best
    }

    /// The measured minus the predicted movements, axis by axis.
    fn residuals(&self, gait: &Gait, start: f64, period: f64) -> Vec<f64> {
        let residual_of = |(time, measured): &(f64, [f64; 3])| {
            let phase = (time - start) / period;
            let predicted = gait.movement_between(phase, phase + self.duration / period);
            [0, 1, 2].map(|axis| measured[axis] - predicted[axis])
        };
        self.movements.iter().flat_map(residual_of).collect()
    }

    /// The [`Movements::residuals`] minus their mean on each axis, so that only the variation within a cycle counts.
    fn centred_residuals(&self, gait: &Gait, start: f64, period: f64) -> Vec<f64> {
        let mut residuals = self.residuals(gait, start, period);
        for axis in 0..3 {
            let on_axis = residuals.iter().skip(axis).step_by(3);
            let mean = on_axis.sum::<f64>() / self.movements.len() as f64;
            residuals
                .iter_mut()
                .skip(axis)
                .step_by(3)
                .for_each(|residual| *residual -= mean);
        }
        residuals
    }
}

/// The durations of a cycle that are tried if the picture rate may be wrong.
fn wide_periods(gait: &Gait) -> Vec<f64> {
    let step_count = (MAX_RATE_ERROR / SEARCH_STEP) as i32;
    let period_of = |index: i32| gait.period * (1.0 + SEARCH_STEP * f64::from(index));
    (-step_count..=step_count).map(period_of).collect()
}

/// The durations of a cycle that are tried first.
fn likely_periods(gait: &Gait) -> [f64; 5] {
    [-2.0, -1.0, 0.0, 1.0, 2.0].map(|sigmas| gait.period * (1.0 + PERIOD_SIGMA * sigmas))
}

fn squared_norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}
