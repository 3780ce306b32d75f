//! The rate of a servo in large steps, computed from frames of the turning horn.
//!
//! At full torque a motor accelerates towards a steady rate with its rotor time constant. Data sheets give the steady
//! rate; a straight line through the middle of a step of 60 deg would give 2 % less. A video with few frames per second
//! hardly distinguishes the rate from the time constant. The fit therefore assumes the time constant in robot.toml to
//! be right within a factor of two, and the error of the rate includes this uncertainty.

use nalgebra::DMatrix;

use crate::estimate::Estimate;
use crate::least_squares::{self, propagate_variance};
use crate::mean::small_sample_factor;

/// Range of a step from which frames are used, as fractions of the step. Above this range, the servo begins to brake.
const USED_FRACTION_RANGE: [f64; 2] = [0.02, 0.85];
/// Expected standard deviation of the time constant's natural logarithm.
const LOG_SIGMA: f64 = 0.7;
/// Largest standard error of the time constant's natural logarithm at which the time constant counts as measured.
const MAX_LOG_ERROR: f64 = 0.25;
/// Relative standard error of a time constant due to the simple motor model.
const MOTOR_SIGMA: f64 = 0.02;
/// First estimate of an angle's standard error in one frame, deg; the residuals of the first fit then replace it.
const ANGLE_SIGMA: f64 = 0.3;
/// Number of groups of steps that are fitted together: both directions, or without and with a load.
const GROUP_COUNT: usize = 2;
/// Smallest number of steps in a group, counting only steps with at least two frames.
const MIN_STEPS: usize = 2;
/// Smallest number of frames in a group, not counting the first frame of each step.
const MIN_FRAMES: usize = 6;

/// The frames of a large step that the fit uses.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LargeStep {
    /// The time of each frame, s, and the angle by which the horn has turned since the start of the step, deg, always
    /// positive.
    frames: Vec<(f64, f64)>,
}

impl LargeStep {
    /// Selects the frames that the fit uses. `frames` has the time of each frame, s, and the horn's angle relative to
    /// the start of the step, deg. `step_deg` is the angle of the whole step. Counter-clockwise is positive.
    pub(crate) fn new(frames: impl Iterator<Item = (f64, f64)>, step_deg: f64) -> Self {
        let [low, high] = USED_FRACTION_RANGE.map(|fraction| fraction * step_deg.abs());
        let turns = frames.map(|(time, angle)| (time, angle * step_deg.signum()));
        let before_braking = turns.take_while(|(_, angle)| *angle < high);
        Self {
            frames: before_braking.filter(|(_, angle)| *angle > low).collect(),
        }
    }
}

/// The rates of two groups of steps, and their common time constant.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rates {
    /// The rate of each group, deg/s.
    pub rates: [f64; GROUP_COUNT],
    /// The covariance of the rates.
    covariance: DMatrix<f64>,
    /// The common time constant, s; `None` if the video does not determine it.
    pub rotor_time_constant: Option<Estimate>,
}

impl Rates {
    /// Fits groups of steps, each with its own rate; `None` if there are too few frames or the fit fails.
    /// `expected_time_constant` is in s.
    pub(crate) fn fit(
        groups: [&[LargeStep]; GROUP_COUNT],
        expected_time_constant: f64,
    ) -> Option<Self> {
        // The parameters: the rate of each group; the logarithm of the time constant relative to the expected one; the
        // time at which each step begins.
        let mut first_guess = Vec::new();
        let mut steps: Vec<(usize, &LargeStep)> = Vec::new();
        for (group_index, group) in groups.into_iter().enumerate() {
            let usable_steps = group.iter().filter(|step| step.frames.len() > 1);
            let usable_steps: Vec<&LargeStep> = usable_steps.collect();
            let frame_count: usize = usable_steps.iter().map(|step| step.frames.len() - 1).sum();
            if usable_steps.len() < MIN_STEPS || frame_count < MIN_FRAMES {
                return None;
            }
            let rates = usable_steps.iter().map(|step| mean_rate(step));
            first_guess.push(rates.sum::<f64>() / usable_steps.len() as f64);
            steps.extend(usable_steps.into_iter().map(|step| (group_index, step)));
        }
        first_guess.push(0.0);
        for (group, step) in &steps {
            let (time, angle) = step.frames[0];
            first_guess.push(time - angle / first_guess[*group] - expected_time_constant);
        }
        let residuals = |parameters: &[f64], sigma: f64| {
            let time_constant = expected_time_constant * parameters[GROUP_COUNT].exp();
            let mut all_residuals = vec![parameters[GROUP_COUNT] / LOG_SIGMA];
            for ((group, step), begin) in steps.iter().zip(&parameters[GROUP_COUNT + 1..]) {
                let residual = |(time, angle): &(f64, f64)| {
                    (angle_after(parameters[*group], time_constant, time - begin) - angle) / sigma
                };
                all_residuals.extend(step.frames.iter().map(residual));
            }
            all_residuals
        };
        let first_fit = least_squares::fit(&first_guess, |parameters| {
            residuals(parameters, ANGLE_SIGMA)
        })?;
        let total_frame_count: usize = steps.iter().map(|(_, step)| step.frames.len()).sum();
        let degrees_of_freedom = total_frame_count
            .checked_sub(steps.len() + GROUP_COUNT)
            .filter(|n| *n > 0)?;
        let variance = first_fit.sum_of_squares / degrees_of_freedom as f64;
        let sigma = ANGLE_SIGMA * variance.sqrt().max(0.05);
        let rescaled_residuals = |parameters: &[f64]| residuals(parameters, sigma);
        let fit = least_squares::fit(&first_fit.parameters, rescaled_residuals)?;
        let variance_factor = small_sample_factor(degrees_of_freedom).powi(2);
        let covariance = fit.covariance.view((0, 0), (GROUP_COUNT, GROUP_COUNT));
        let log_error = fit.covariance[(GROUP_COUNT, GROUP_COUNT)].sqrt();
        let time_constant = expected_time_constant * fit.parameters[GROUP_COUNT].exp();
        let rotor_time_constant =
            Estimate::new(time_constant, time_constant * log_error.hypot(MOTOR_SIGMA));
        Some(Self {
            rates: std::array::from_fn(|group| fit.parameters[group]),
            covariance: covariance * variance_factor,
            rotor_time_constant: (log_error < MAX_LOG_ERROR).then_some(rotor_time_constant),
        })
    }

    /// Propagates the errors of the rates to a value that is computed from them. `gradient` has the value's derivative
    /// with respect to each rate.
    pub(crate) fn propagate_error(&self, value: f64, gradient: [f64; GROUP_COUNT]) -> Estimate {
        let variance = propagate_variance(&gradient, &self.covariance);
        Estimate::new(value, variance.sqrt())
    }
}

/// Computes the mean rate of a step with at least two frames, deg/s.
fn mean_rate(step: &LargeStep) -> f64 {
    let ((start_time, start_angle), (end_time, end_angle)) =
        (step.frames[0], step.frames[step.frames.len() - 1]);
    (end_angle - start_angle) / (end_time - start_time)
}

/// Computes the angle by which a motor turns in the first `seconds` at full torque, deg. `rate` is the steady rate,
/// deg/s, and `time_constant` the rotor time constant, s.
fn angle_after(rate: f64, time_constant: f64, seconds: f64) -> f64 {
    if seconds <= 0.0 {
        return 0.0;
    }
    rate * (seconds + time_constant * (-seconds / time_constant).exp_m1())
}
