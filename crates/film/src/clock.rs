//! The beginning and the time of a cycle, by the movement within it.
//!
//! The movement over a part of a cycle must fit the predicted one. Its mean does not count for that, only its ups
//! and downs, because the mean is what is to be measured. If it fits much better to cycles that take twice as long or more,
//! the pace was another one, or the film is in slow motion.

use crate::gait::{Gait, movement, size};
use crate::least;
use crate::path::{self, Seen};
use crate::trouble::Trouble;

/// Part of a cycle over which the movement is compared.
const PART: f64 = 0.25;
/// Least number of movements.
const LEAST: usize = 8;
/// Standard deviation of a cycle's time, as a share: the board has a ceramic resonator.
const SIGMA: f64 = 0.003;
/// Number of beginnings that are tried.
const BEGINNINGS: usize = 48;
/// Difference from the predicted movement, as a share of the sum of both squares, from which it is another gait.
const ANOTHER: f64 = 0.5;
/// Longer times of a cycle that are tried.
const LONGER: [u32; 3] = [2, 4, 8];
/// Share of the difference, and of the movement itself, that a longer time leaves if it is the right one.
const MUCH_BETTER: f64 = 0.3;

/// The beginning of cycles, and their time with its standard error, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Clock {
    pub start: f64,
    pub period: [f64; 2],
}

/// The movements from each picture to a time that is later by a part of a cycle.
#[derive(Debug, Clone)]
pub(crate) struct Steps {
    /// The part of a cycle, s.
    later: f64,
    /// Times of the pictures, s, and movements.
    steps: Vec<(f64, [f64; 3])>,
}

impl Steps {
    /// The movements of a path.
    pub(crate) fn of(path: &[Seen], period: f64) -> Self {
        let later = PART * period;
        let step = |seen: &Seen| {
            let there = path::between(path, seen.seconds + later)?;
            Some((seen.seconds, movement(there.seen_from(seen.place))))
        };
        Self {
            later,
            steps: path.iter().filter_map(step).collect(),
        }
    }

    /// True if there are too few of them for a fit.
    pub(crate) fn are_few(&self) -> bool {
        self.steps.len() < LEAST
    }

    /// Finds the beginning and the time of a cycle.
    ///
    /// # Errors
    /// Fails if the movement is that of another gait or pace.
    pub(crate) fn clock(&self, gait: &Gait) -> Result<Clock, Trouble> {
        let tries = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|sigmas| gait.period * (1.0 + SIGMA * sigmas));
        let near = |start: f64, period: f64| squares(&self.sways(gait, start, period));
        let (least, start, period) = self.best(gait.period, &tries, near);
        let away = |start: f64, period: f64| squares(&self.differences(gait, start, period));
        let here = away(start, period);
        let moved: f64 = self.steps.iter().map(|(_, seen)| size(*seen).powi(2)).sum();
        let longer = LONGER.map(|times| {
            let period = f64::from(times) * gait.period;
            (self.best(period, &[period], away).0, times)
        });
        let longer = longer.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((there, times)) = longer
            && there < MUCH_BETTER * here.min(moved)
        {
            return Err(Trouble::AnotherPace { times });
        }
        let both = |(time, seen): &(f64, [f64; 3])| {
            let phase = (time - start) / period;
            let predicted = gait.step(phase, phase + self.later / period);
            size(*seen).powi(2) + size(predicted).powi(2)
        };
        if here > ANOTHER * self.steps.iter().map(both).sum::<f64>() {
            return Err(Trouble::NotThisGait {
                period: gait.period,
            });
        }
        let sigma = (least / (3 * self.steps.len()) as f64).sqrt().max(1e-3);
        let model = |at: &[f64]| {
            let mut all = self.sways(gait, at[0], at[1]);
            all.iter_mut().for_each(|value| *value /= sigma);
            all.push((at[1] / gait.period - 1.0) / SIGMA);
            // Keeps the start where nothing within a cycle tells it.
            all.push((at[0] - start) / gait.period);
            all
        };
        Ok(match least::fit(&[start, period], model) {
            Some(fit) => Clock {
                start: fit.at[0],
                period: [fit.at[1], fit.covariance[(1, 1)].sqrt()],
            },
            None => Clock {
                start,
                period: [period, SIGMA * gait.period],
            },
        })
    }

    /// The least value of a function of start and time of a cycle with both, over starts within a cycle of
    /// about `period`.
    fn best(
        &self,
        period: f64,
        periods: &[f64],
        value: impl Fn(f64, f64) -> f64,
    ) -> (f64, f64, f64) {
        let first = self.steps[0].0;
        let middle = ((self.steps[self.steps.len() / 2].0 - first) / period).floor();
        let mut best = (f64::INFINITY, first, period);
        for i in 0..BEGINNINGS {
            let start = first + period * i as f64 / BEGINNINGS as f64;
            for &other in periods {
                // The middle of the film keeps its phase while the time of a cycle changes.
                let start = start + middle * (period - other);
                let value = value(start, other);
                if value < best.0 {
                    best = (value, start, other);
                }
            }
        }
        best
    }

    /// The movements less those predicted, axis by axis.
    fn differences(&self, gait: &Gait, start: f64, period: f64) -> Vec<f64> {
        let difference = |(time, seen): &(f64, [f64; 3])| {
            let phase = (time - start) / period;
            let predicted = gait.step(phase, phase + self.later / period);
            [0, 1, 2].map(|axis| seen[axis] - predicted[axis])
        };
        self.steps.iter().flat_map(difference).collect()
    }

    /// The differences less their means: those of the ups and downs.
    fn sways(&self, gait: &Gait, start: f64, period: f64) -> Vec<f64> {
        let mut sways = self.differences(gait, start, period);
        for axis in 0..3 {
            let own = sways.iter().skip(axis).step_by(3);
            let mean = own.sum::<f64>() / self.steps.len() as f64;
            sways
                .iter_mut()
                .skip(axis)
                .step_by(3)
                .for_each(|sway| *sway -= mean);
        }
        sways
    }
}

fn squares(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}
