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
const USED_SHARES: [f64; 2] = [0.02, 0.85];
/// Expected standard deviation of the logarithm of the time constant.
const SPIN_UP_SIGMA: f64 = 0.7;
/// Largest standard error of that logarithm with which the film determines the time constant.
const MAX_LOG_ERROR: f64 = 0.25;
/// Standard error of a time constant because the motor model is simple, as a share.
const MOTOR_SIGMA: f64 = 0.02;
/// First estimate of the error of an angle in one picture, deg; the residuals give the true one.
const ANGLE_SIGMA: f64 = 0.3;
/// Smallest number of steps with two pictures or more in a group.
const MIN_STEPS: usize = 2;
/// Smallest number of pictures in a group, not counting the first picture of each step.
const MIN_PICTURES: usize = 6;

/// A large step: times in s, and angles in deg from the start of the step.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Step(Vec<(f64, f64)>);

impl Step {
    /// Selects the pictures that the fit uses, for a step of `step_deg` deg.
    pub(crate) fn new(pictures: impl Iterator<Item = (f64, f64)>, step_deg: f64) -> Self {
        let [low, high] = USED_SHARES.map(|share| share * step_deg.abs());
        let turns = pictures.map(|(time, angle)| (time, angle * step_deg.signum()));
        let before_braking = turns.take_while(|(_, angle)| *angle < high);
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
            let usable_steps = || group.iter().filter(|step| step.0.len() > 1);
            let picture_count: usize = usable_steps().map(|step| step.0.len() - 1).sum();
            if usable_steps().count() < MIN_STEPS || picture_count < MIN_PICTURES {
                return None;
            }
            start.push(usable_steps().map(mean_rate).sum::<f64>() / usable_steps().count() as f64);
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
        let residuals = |parameters: &[f64], sigma: f64| {
            let constant = spin_up * parameters[count].exp();
            let mut errors = vec![parameters[count] / SPIN_UP_SIGMA];
            for ((group, step), begin) in steps.iter().zip(&parameters[count + 1..]) {
                let residual_of = |(time, angle): &(f64, f64)| {
                    (angle_after(parameters[*group], constant, time - begin) - angle) / sigma
                };
                errors.extend(step.0.iter().map(residual_of));
            }
            errors
        };
        let first_fit = least::fit(&start, |parameters| residuals(parameters, ANGLE_SIGMA))?;
        let pictures: usize = steps.iter().map(|(_, step)| step.0.len()).sum();
        let freedom = pictures
            .checked_sub(steps.len() + count)
            .filter(|n| *n > 0)?;
        let sigma = ANGLE_SIGMA * (first_fit.squares / freedom as f64).sqrt().max(0.05);
        let fit = least::fit(&first_fit.at, |parameters| residuals(parameters, sigma))?;
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
                error: constant * error.hypot(MOTOR_SIGMA),
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
fn mean_rate(step: &Step) -> f64 {
    let ((from, a), (to, b)) = (step.0[0], step.0[step.0.len() - 1]);
    (b - a) / (to - from)
}

/// The angle that a motor has turned a time after its start at full torque, deg; `constant` is its time constant,
/// s.
fn angle_after(rate: f64, constant: f64, seconds: f64) -> f64 {
    if seconds <= 0.0 {
        return 0.0;
    }
    rate * (seconds + constant * (-seconds / constant).exp_m1())
}
