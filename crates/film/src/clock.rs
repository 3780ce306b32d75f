//! The beginning and the duration of a cycle, found by the movement within it.
//!
//! The movement over a part of a cycle must fit the predicted one. Only its variation counts, not its mean, because
//! the mean is to be measured. If the movement fits much better to cycles that take twice as long or more, the robot
//! was driven at another pace, or the film is in slow motion.

use crate::gait::{Gait, movement, size};
use crate::least;
use crate::path::{self, PathPoint};
use crate::trouble::Trouble;

/// Duration of a compared movement, in cycles.
const STEP_CYCLES: f64 = 0.25;
/// Smallest number of movements.
const MIN_STEPS: usize = 8;
/// Standard deviation of a cycle's duration, as a share: the board has a ceramic resonator.
const PERIOD_SIGMA: f64 = 0.003;
/// Largest share by which a wrong picture rate makes a cycle longer or shorter, such as 25 per second taken for 24
/// or 27.
const LARGEST_RATE_ERROR: f64 = 0.08;
/// Step of the search for the duration of a cycle if the picture rate is wrong, as a share.
const SEARCH_STEP: f64 = 0.005;
/// Standard deviation of a duration found by that search, as a share.
const SEARCH_SIGMA: f64 = 0.01;
/// Number of cycle beginnings that are tried.
const BEGINNINGS: usize = 48;
/// Squared difference between measured and predicted movements above which the gait counts as another one, as a share
/// of the sum of the squares of both.
const MAX_MISFIT_SHARE: f64 = 0.5;
/// Squared difference between the movements of two consecutive cycles above which they count as different, as a share
/// of the mean of the squares of both.
const MIN_CHANGE_SHARE: f64 = 0.15;
/// Multiples of a cycle's duration that are tried.
const MULTIPLES: [u32; 3] = [2, 4, 8];
/// Largest ratio of the misfit with another cycle duration to the misfit with the expected duration at which the
/// other duration is accepted. For a multiple of the duration, the misfit must also be below this share of the sum of
/// squares of the measured movements.
const MAX_MISFIT_RATIO: f64 = 0.3;

/// The beginning of a cycle and the duration of a cycle, each with its standard error, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Clock {
    pub start: [f64; 2],
    pub period: [f64; 2],
}

/// The robot's movements over a fixed part of a cycle, one movement from each picture.
#[derive(Debug, Clone)]
pub(crate) struct Steps {
    /// Duration of each movement, s.
    later: f64,
    /// Time of the picture at which a movement begins, s, and the movement.
    steps: Vec<(f64, [f64; 3])>,
}

impl Steps {
    /// Computes the movements along a path; the robot's cycles last `period` seconds.
    pub(crate) fn from_path(path: &[PathPoint], period: f64) -> Self {
        let later = STEP_CYCLES * period;
        let step_from = |point: &PathPoint| {
            let later_place = path::interpolate_at(path, point.seconds + later)?;
            Some((point.seconds, movement(later_place.seen_from(point.place))))
        };
        Self {
            later,
            steps: path.iter().filter_map(step_from).collect(),
        }
    }

    /// True if there are too few movements for a fit.
    pub(crate) fn are_few(&self) -> bool {
        self.steps.len() < MIN_STEPS
    }

    /// Finds the beginning and the duration of a cycle.
    ///
    /// # Errors
    /// Fails if the movement shows another gait or pace.
    pub(crate) fn clock(&self, gait: &Gait) -> Result<Clock, Trouble> {
        let periods = likely_periods(gait);
        let variation_misfit =
            |start: f64, period: f64| squared_norm(&self.variations(gait, start, period));
        let (mut least_misfit, mut start, mut period) =
            self.minimize(gait.period, &periods, variation_misfit);
        let (mut expected, mut relative_sigma) = (gait.period, PERIOD_SIGMA);
        // If the picture rate is wrong, only the path itself gives the duration of a cycle.
        let wide_fit = self.minimize(gait.period, &wide_periods(gait), variation_misfit);
        if wide_fit.0 < MAX_MISFIT_RATIO * least_misfit {
            (least_misfit, start, period) = wide_fit;
            (expected, relative_sigma) = (period, SEARCH_SIGMA);
        }
        let misfit = squared_norm(&self.differences(gait, start, period));
        let (longer_misfit, multiple) = self.misfit_of_longer(gait);
        if longer_misfit < MAX_MISFIT_RATIO * (misfit / self.sum_of_squares()).min(1.0) {
            return Err(Trouble::AnotherPace { times: multiple });
        }
        let squares_of_both = |(time, measured): &(f64, [f64; 3])| {
            let phase = (time - start) / period;
            let predicted = gait.step(phase, phase + self.later / period);
            size(*measured).powi(2) + size(predicted).powi(2)
        };
        if misfit > MAX_MISFIT_SHARE * self.steps.iter().map(squares_of_both).sum::<f64>() {
            return Err(Trouble::NotThisGait {
                period: gait.period,
            });
        }
        let sigma = (least_misfit / (3 * self.steps.len()) as f64)
            .sqrt()
            .max(1e-3);
        let model = |parameters: &[f64]| {
            let mut residuals = self.variations(gait, parameters[0], parameters[1]);
            residuals.iter_mut().for_each(|value| *value /= sigma);
            residuals.push((parameters[1] / expected - 1.0) / relative_sigma);
            // Keeps the start near its first value if nothing within a cycle determines it.
            residuals.push((parameters[0] - start) / gait.period);
            residuals
        };
        Ok(match least::fit(&[start, period], model) {
            Some(fit) => Clock {
                start: [fit.at[0], fit.covariance[(0, 0)].sqrt()],
                period: [fit.at[1], fit.covariance[(1, 1)].sqrt()],
            },
            None => Clock {
                start: [start, gait.period / BEGINNINGS as f64],
                period: [period, relative_sigma * period],
            },
        })
    }

    /// The misfit of a gait: the squared difference between measured and predicted movements, as a share of the
    /// measured movements' squares, with the start and duration of a cycle that fit best.
    pub(crate) fn misfit(&self, gait: &Gait) -> f64 {
        let misfit_of =
            |start: f64, period: f64| squared_norm(&self.differences(gait, start, period));
        self.minimize(gait.period, &likely_periods(gait), misfit_of)
            .0
            / self.sum_of_squares()
    }

    /// The misfit of a gait whose cycles take a multiple of their usual duration, and that multiple; the best of
    /// all multiples that are tried.
    pub(crate) fn misfit_of_longer(&self, gait: &Gait) -> (f64, u32) {
        let misfit_of =
            |start: f64, period: f64| squared_norm(&self.differences(gait, start, period));
        let misfits = MULTIPLES.map(|multiple| {
            let period = f64::from(multiple) * gait.period;
            (
                self.minimize(period, &[period], misfit_of).0 / self.sum_of_squares(),
                multiple,
            )
        });
        let best = misfits.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        best.unwrap_or((f64::INFINITY, 1))
    }

    /// The sum of the squares of the measured movements.
    fn sum_of_squares(&self) -> f64 {
        self.steps
            .iter()
            .map(|(_, measured)| size(*measured).powi(2))
            .sum()
    }

    /// The beginning of the first cycle whose movement differs from that of the next cycle, s; `None` if all are
    /// alike.
    pub(crate) fn change(&self, period: f64) -> Option<f64> {
        let first = self.steps.first()?.0;
        let last = self.steps.last()?.0;
        let cycles = ((last - first) / period) as usize;
        let beginnings = (1..cycles).map(|i| first + (i - 1) as f64 * period);
        beginnings.into_iter().find(|beginning| {
            let is_in_cycle =
                |(time, _): &&(f64, [f64; 3])| (*beginning..beginning + period).contains(time);
            let (mut difference, mut mean_squares) = (0.0, 0.0);
            for (time, step) in self.steps.iter().filter(is_in_cycle) {
                if let Some(next) = self.step_at(time + period) {
                    difference += size([0, 1, 2].map(|axis| next[axis] - step[axis])).powi(2);
                    mean_squares += (size(next).powi(2) + size(*step).powi(2)) / 2.0;
                }
            }
            difference > MIN_CHANGE_SHARE * mean_squares
        })
    }

    /// The movement that begins at a time between two pictures, interpolated; `None` outside the film.
    fn step_at(&self, seconds: f64) -> Option<[f64; 3]> {
        let next_index = self.steps.partition_point(|(time, _)| *time < seconds);
        let (b, later) = self.steps.get(next_index)?;
        let (a, earlier) = self.steps.get(next_index.checked_sub(1)?)?;
        let share = (seconds - a) / (b - a);
        Some([0, 1, 2].map(|axis| earlier[axis] + share * (later[axis] - earlier[axis])))
    }

    /// Minimizes a function of a cycle's start and duration; returns its value, the start and the duration. Tries
    /// starts within a cycle of `period`, and all `periods`.
    fn minimize(
        &self,
        period: f64,
        periods: &[f64],
        function: impl Fn(f64, f64) -> f64,
    ) -> (f64, f64, f64) {
        let first = self.steps[0].0;
        let middle_cycle = ((self.steps[self.steps.len() / 2].0 - first) / period).floor();
        let mut best = (f64::INFINITY, first, period);
        for i in 0..BEGINNINGS {
            let start = first + period * i as f64 / BEGINNINGS as f64;
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
    fn differences(&self, gait: &Gait, start: f64, period: f64) -> Vec<f64> {
        let difference_of = |(time, measured): &(f64, [f64; 3])| {
            let phase = (time - start) / period;
            let predicted = gait.step(phase, phase + self.later / period);
            [0, 1, 2].map(|axis| measured[axis] - predicted[axis])
        };
        self.steps.iter().flat_map(difference_of).collect()
    }

    /// The [`Steps::differences`] minus their mean on each axis, so that only the variation within a cycle counts.
    fn variations(&self, gait: &Gait, start: f64, period: f64) -> Vec<f64> {
        let mut variations = self.differences(gait, start, period);
        for axis in 0..3 {
            let on_axis = variations.iter().skip(axis).step_by(3);
            let mean = on_axis.sum::<f64>() / self.steps.len() as f64;
            variations
                .iter_mut()
                .skip(axis)
                .step_by(3)
                .for_each(|variation| *variation -= mean);
        }
        variations
    }
}

/// The durations of a cycle that are tried if the picture rate may be wrong.
fn wide_periods(gait: &Gait) -> Vec<f64> {
    let steps = (LARGEST_RATE_ERROR / SEARCH_STEP) as i32;
    let period_of = |step: i32| gait.period * (1.0 + SEARCH_STEP * f64::from(step));
    (-steps..=steps).map(period_of).collect()
}

/// The durations of a cycle that are tried first.
fn likely_periods(gait: &Gait) -> [f64; 5] {
    [-2.0, -1.0, 0.0, 1.0, 2.0].map(|sigmas| gait.period * (1.0 + PERIOD_SIGMA * sigmas))
}

fn squared_norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}
