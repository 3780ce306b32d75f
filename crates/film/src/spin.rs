//! The rate of a servo in large steps, found by pictures of the turning horn.
//!
//! At full torque a motor accelerates toward a steady rate with the time constant of its rotor. Data sheets give the
//! steady rate; a straight line through the middle of a step of 60 deg would show 2 % less. A film with few pictures
//! per second hardly separates rate and time constant. So the constant is expected within a factor of two of that in
//! robot.toml, and the error of the rate includes this uncertainty.

use crate::figure::Figure;
use crate::least;
use crate::mean::widening;

/// Shares of a step between which pictures are used; beyond the upper one the servo begins to brake.
const PARTS: [f64; 2] = [0.02, 0.85];
/// Expected standard deviation of the logarithm of the time constant.
const SPIN_UP_SIGMA: f64 = 0.7;
/// Largest standard error of that logarithm with which the film determines the time constant.
const MAX_LOG_ERROR: f64 = 0.25;
/// Standard error of a time constant because the motor model is simple, as a share.
const MOTOR: f64 = 0.02;
/// First estimate of the error of an angle in one picture, deg; the residuals give the true one.
const SIGMA: f64 = 0.3;
/// Smallest number of steps with two pictures or more in a group.
const LEAST_STEPS: usize = 2;
/// Smallest number of pictures in a group, not counting the first picture of each step.
const LEAST_PICTURES: usize = 6;

/// A large step: times in s, and angles in deg from the start of the step.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Step(Vec<(f64, f64)>);

impl Step {
    /// Selects the pictures that the fit uses, for a step of `way` deg.
    pub(crate) fn new(pictures: impl Iterator<Item = (f64, f64)>, way: f64) -> Self {
        let [low, high] = PARTS.map(|part| part * way.abs());
        let turned = pictures.map(|(time, angle)| (time, angle * way.signum()));
        let before_braking = turned.take_while(|(_, angle)| *angle < high);
        Self(before_braking.filter(|(_, angle)| *angle > low).collect())
    }
}

/// The rates of groups of steps, deg/s, with their covariance, and their common time constant, s.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rates {
    /// The rate of each group.
    pub rates: Vec<f64>,
    covariance: Vec<Vec<f64>>,
    /// The time constant, if the film determines it.
    pub spin_up: Option<Figure>,
}

impl Rates {
    /// Fits groups of steps, each group with its own rate; `None` if there are too few pictures or the fit fails.
    /// `spin_up` is the expected time constant, s.
    pub(crate) fn of(groups: &[&[Step]], spin_up: f64) -> Option<Self> {
        let mut start = Vec::new();
        for group in groups {
            let seen = || group.iter().filter(|step| step.0.len() > 1);
            let more: usize = seen().map(|step| step.0.len() - 1).sum();
            if seen().count() < LEAST_STEPS || more < LEAST_PICTURES {
                return None;
            }
            start.push(seen().map(pace).sum::<f64>() / seen().count() as f64);
        }
        let count = start.len();
        start.push(0.0);
        let steps: Vec<(usize, &Step)> = groups
            .iter()
            .enumerate()
            .flat_map(|(group, steps)| steps.iter().map(move |step| (group, step)))
            .filter(|(_, step)| step.0.len() > 1)
            .collect();
        for (group, step) in &steps {
            let (time, angle) = step.0[0];
            start.push(time - angle / start[*group] - spin_up);
        }
        let residuals = |at: &[f64], sigma: f64| {
            let constant = spin_up * at[count].exp();
            let mut all = vec![at[count] / SPIN_UP_SIGMA];
            for ((group, step), begin) in steps.iter().zip(&at[count + 1..]) {
                let residual = |(time, angle): &(f64, f64)| {
                    (turned(at[*group], constant, time - begin) - angle) / sigma
                };
                all.extend(step.0.iter().map(residual));
            }
            all
        };
        let first = least::fit(&start, |at| residuals(at, SIGMA))?;
        let pictures: usize = steps.iter().map(|(_, step)| step.0.len()).sum();
        let freedom = pictures
            .checked_sub(steps.len() + count)
            .filter(|n| *n > 0)?;
        let sigma = SIGMA * (first.squares / freedom as f64).sqrt().max(0.05);
        let fit = least::fit(&first.at, |at| residuals(at, sigma))?;
        let widening = widening(freedom).powi(2);
        let [log, error] = [fit.at[count], fit.covariance[(count, count)].sqrt()];
        let constant = spin_up * log.exp();
        Some(Self {
            rates: fit.at[..count].to_vec(),
            covariance: (0..count)
                .map(|i| {
                    (0..count)
                        .map(|j| widening * fit.covariance[(i, j)])
                        .collect()
                })
                .collect(),
            spin_up: (error < MAX_LOG_ERROR).then_some(Figure {
                value: constant,
                error: constant * error.hypot(MOTOR),
            }),
        })
    }

    /// A value derived from the rates, with its error by propagation; `slopes` are its derivatives by each rate.
    pub(crate) fn figure(&self, value: f64, slopes: &[f64]) -> Figure {
        let pairs = slopes.iter().zip(&self.covariance).flat_map(|(a, row)| {
            row.iter()
                .zip(slopes)
                .map(move |(covariance, b)| a * covariance * b)
        });
        Figure {
            value,
            error: pairs.sum::<f64>().max(0.0).sqrt(),
        }
    }
}

/// The mean rate of a step with two pictures or more.
fn pace(step: &Step) -> f64 {
    let ((from, a), (to, b)) = (step.0[0], step.0[step.0.len() - 1]);
    (b - a) / (to - from)
}

/// The angle that a motor has turned a time after its start at full torque, deg; `constant` is its time constant,
/// s.
fn turned(rate: f64, constant: f64, seconds: f64) -> f64 {
    if seconds <= 0.0 {
        return 0.0;
    }
    rate * (seconds + constant * (-seconds / constant).exp_m1())
}
