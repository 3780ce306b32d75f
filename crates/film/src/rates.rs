//! The rate of a servo in large steps, found from pictures of the turning horn.
//!
//! At full torque a motor accelerates toward a steady rate with the time constant of its rotor. Data sheets give the
//! steady rate; a straight line through the middle of a step of 60 deg would give 2 % less. A film with few pictures
//! per second hardly distinguishes the rate from the time constant. So the fit expects the time constant of robot.toml
//! within a factor of two, and the error of the rate includes this uncertainty.

use crate::figure::Figure;
use crate::least_squares;
use crate::mean::small_sample_factor;

/// Shares of a step between which pictures are used; beyond the upper share the servo begins to brake.
const USED_SHARE_RANGE: [f64; 2] = [0.02, 0.85];
/// Expected standard deviation of the logarithm of the time constant.
const SPIN_UP_SIGMA: f64 = 0.7;
/// Largest standard error of the logarithm of the time constant at which the film counts as determining it.
const MAX_LOG_ERROR: f64 = 0.25;
/// Standard error that the simple motor model causes in a time constant, as a share.
const MOTOR_SIGMA: f64 = 0.02;
/// First estimate of the error of an angle in one picture, deg; the residuals give the true one.
const ANGLE_SIGMA: f64 = 0.3;
/// Smallest number of steps with two pictures or more in a group.
const MIN_STEPS: usize = 2;
/// Smallest number of pictures in a group, not counting the first picture of each step.
const MIN_PICTURES: usize = 6;

/// A large step, as the fit uses it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LargeStep {
    /// For each picture the time, s, and the angle turned since the start of the step, deg, always positive.
    pictures: Vec<(f64, f64)>,
}

impl LargeStep {
    /// Selects the pictures that the fit uses: times, s, and angles since the start of a step of `step_deg` deg.
    pub(crate) fn new(pictures: impl Iterator<Item = (f64, f64)>, step_deg: f64) -> Self {
        let [low, high] = USED_SHARE_RANGE.map(|share| share * step_deg.abs());
        let turns = pictures.map(|(time, angle)| (time, angle * step_deg.signum()));
        let before_braking = turns.take_while(|(_, angle)| *angle < high);
        Self {
            pictures: before_braking.filter(|(_, angle)| *angle > low).collect(),
        }
    }
}

/// The rates of groups of steps, and their common time constant.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rates {
    /// The rate of each group, deg/s.
    pub rates: Vec<f64>,
    /// The covariance of the rates.
    covariance: Vec<Vec<f64>>,
    /// The common time constant, s, if the film determines it.
    pub spin_up: Option<Figure>,
}

impl Rates {
    /// Fits groups of steps, each group with its own rate; `None` if there are too few pictures or the fit fails.
    /// `expected_spin_up` is the expected time constant, s.
    pub(crate) fn fit(groups: &[&[LargeStep]], expected_spin_up: f64) -> Option<Self> {
        let mut start = Vec::new();
        for group in groups {
            let usable_steps = || group.iter().filter(|step| step.pictures.len() > 1);
            let picture_count: usize = usable_steps().map(|step| step.pictures.len() - 1).sum();
            if usable_steps().count() < MIN_STEPS || picture_count < MIN_PICTURES {
                return None;
            }
            start.push(usable_steps().map(mean_rate).sum::<f64>() / usable_steps().count() as f64);
        }
        let group_count = start.len();
        start.push(0.0);
        let steps: Vec<(usize, &LargeStep)> = groups
            .iter()
            .enumerate()
            .flat_map(|(group, steps)| steps.iter().map(move |step| (group, step)))
            .filter(|(_, step)| step.pictures.len() > 1)
            .collect();
        for (group, step) in &steps {
            let (time, angle) = step.pictures[0];
            start.push(time - angle / start[*group] - expected_spin_up);
        }
        let residuals = |parameters: &[f64], sigma: f64| {
            let time_constant = expected_spin_up * parameters[group_count].exp();
            let mut all_residuals = vec![parameters[group_count] / SPIN_UP_SIGMA];
            for ((group, step), begin) in steps.iter().zip(&parameters[group_count + 1..]) {
                let residual_of = |(time, angle): &(f64, f64)| {
                    (angle_after(parameters[*group], time_constant, time - begin) - angle) / sigma
                };
                all_residuals.extend(step.pictures.iter().map(residual_of));
            }
            all_residuals
        };
        let first_fit =
            least_squares::fit(&start, |parameters| residuals(parameters, ANGLE_SIGMA))?;
        let total_picture_count: usize = steps.iter().map(|(_, step)| step.pictures.len()).sum();
        let degrees_of_freedom = total_picture_count
            .checked_sub(steps.len() + group_count)
            .filter(|n| *n > 0)?;
        let sigma = ANGLE_SIGMA
            * (first_fit.sum_of_squares / degrees_of_freedom as f64)
                .sqrt()
                .max(0.05);
        let fit = least_squares::fit(&first_fit.parameters, |parameters| {
            residuals(parameters, sigma)
        })?;
        let variance_factor = small_sample_factor(degrees_of_freedom).powi(2);
        let [log_ratio, log_error] = [
            fit.parameters[group_count],
            fit.covariance[(group_count, group_count)].sqrt(),
        ];
        let time_constant = expected_spin_up * log_ratio.exp();
        Some(Self {
            rates: fit.parameters[..group_count].to_vec(),
            covariance: (0..group_count)
                .map(|i| {
                    (0..group_count)
                        .map(|j| variance_factor * fit.covariance[(i, j)])
                        .collect()
                })
                .collect(),
            spin_up: (log_error < MAX_LOG_ERROR).then_some(Figure {
                value: time_constant,
                error: time_constant * log_error.hypot(MOTOR_SIGMA),
            }),
        })
    }

    /// Propagates the errors of the rates to a value that is computed from them; `gradient` has its derivative by each
    /// rate.
    pub(crate) fn propagate_error(&self, value: f64, gradient: &[f64]) -> Figure {
        let pairs = gradient.iter().zip(&self.covariance).flat_map(|(a, row)| {
            row.iter()
                .zip(gradient)
                .map(move |(covariance, b)| a * covariance * b)
        });
        Figure {
            value,
            error: pairs.sum::<f64>().max(0.0).sqrt(),
        }
    }
}

/// The mean rate of a step with two pictures or more, deg/s.
fn mean_rate(step: &LargeStep) -> f64 {
    let ((start_time, start_angle), (end_time, end_angle)) =
        (step.pictures[0], step.pictures[step.pictures.len() - 1]);
    (end_angle - start_angle) / (end_time - start_time)
}

/// The angle that a motor has turned some seconds after its start at full torque, deg; `time_constant` is that of its
/// rotor, s.
fn angle_after(rate: f64, time_constant: f64, seconds: f64) -> f64 {
    if seconds <= 0.0 {
        return 0.0;
    }
    rate * (seconds + time_constant * (-seconds / time_constant).exp_m1())
}
