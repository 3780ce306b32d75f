//! A servo measured in a video: the angle by which it turns for its pulses, its rate, and the small steps that it
//! ignores.
//!
//! The servo gets the steps of [`crate::servo_commands`] at equal intervals, but the time of the first step in the
//! video is unknown. This time is found from the angles at which the horn rests, which must depend linearly on the
//! commands.

use std::ops::Range;

use crate::estimate::Estimate;
use crate::least_squares;
use crate::mean::{self, WalkValues, small_sample_factor};
use crate::path::PathPoint;
use crate::rates::{LargeStep, Rates};
use crate::servo_commands::{self, COMMAND_INTERVAL, ServoCommand};
use crate::servo_error::ServoError;

/// Start and end of the horn's rest after a command, as fractions of the command interval.
const REST_FRACTIONS: [f64; 2] = [0.45, 0.92];
/// Step of the search for the time of the first command, as a fraction of the command interval.
const SEARCH_STEP_FRACTION: f64 = 0.02;
/// Smallest fraction of the commands after which the horn must be visible at rest.
const MIN_VISIBLE_FRACTION: f64 = 0.9;
/// Time from a command to the moment at which half of its large step is complete, s.
const HALF_WAY_SECONDS: f64 = 0.1;
/// Smallest turn that shows a moving servo, deg.
const MIN_TURN: f64 = 5.0;
/// Largest fraction of the rest angles' variance that the commands may leave unexplained.
const MAX_UNEXPLAINED_FRACTION: f64 = 0.02;
/// Other command intervals that are tried, as multiples of [`COMMAND_INTERVAL`].
const INTERVAL_MULTIPLES: [f64; 5] = [0.25, 0.5, 2.0, 4.0, 8.0];
/// Largest rate that counts as the servo's own rate, as a fraction of the slew limit.
const MAX_OWN_RATE_FRACTION: f64 = 0.8;
/// Relative standard error of an angle due to the camera.
const CAMERA_SIGMA: f64 = 0.002;
/// Relative standard error of a rate due to the simple motor model.
const MOTOR_SIGMA: f64 = 0.003;
/// Smallest angle that counts as a movement, deg.
const MIN_MOVEMENT: f64 = 0.05;
/// Smallest angle that counts as a movement, as a multiple of its standard error.
const MIN_MOVEMENT_SIGMAS: f64 = 3.0;
/// Largest movement in a small step that is used for the dead band, deg: after a larger one the servo overshoots.
const MAX_SMALL_MOVEMENT: f64 = 1.6;
/// Standard error of the dead band's width, deg: the servo does not always stop at the edge of the dead band.
const DEAD_BAND_SIGMA: f64 = 0.06;
/// Relative standard error of the load's torque: half a millimetre in a lever arm of 20 mm.
const LOAD_SIGMA: f64 = 0.025;

/// The known parameters of the jig, which holds a servo under the camera with the sheet's card on the horn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jig {
    /// Side of neutral on which the poses lie: 1 for counter-clockwise, -1 for clockwise.
    pub side: f64,
    /// Slew limit of the commands, deg/s.
    pub slew: f64,
    /// Expected rotor time constant, s.
    pub rotor_time_constant: f64,
}

/// The dead band, measured with small steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeadBand {
    /// Width, nominal deg; `None` if too few small steps moved the servo.
    pub width: Option<Estimate>,
    /// Largest small step that did not move the servo, nominal deg; 0 if all steps moved the servo.
    pub largest_ignored_step: f64,
}

/// A measured servo. A nominal deg is a deg according to the pulse scale in robot.toml.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredServo {
    /// Angle by which the servo turns per nominal deg; negative if it turns in the opposite direction.
    pub gain: Estimate,
    /// Difference between the angles at which the servo stops when it approaches from either side, nominal deg.
    pub hysteresis: Estimate,
    /// The dead band.
    pub dead_band: DeadBand,
    /// Mean of the rates in both directions, deg/s.
    pub rate: Estimate,
    /// Rates counter-clockwise and clockwise, deg/s.
    pub rates: [Estimate; 2],
    /// Rotor time constant, s; `None` if the video has too few frames to determine it.
    pub rotor_time_constant: Option<Estimate>,
    /// Time of the first command, s.
    pub first_command_seconds: f64,
    /// Frames per second.
    pub frame_rate: f64,
    /// The large steps, counter-clockwise and clockwise.
    large_steps: [Vec<LargeStep>; 2],
    /// Expected rotor time constant, s.
    expected_time_constant: f64,
}

impl MeasuredServo {
    /// Measures a servo from the path of the card on its horn.
    ///
    /// # Errors
    /// Fails if the horn does not turn as commanded or is visible in too few frames, or if the rate is near the slew
    /// limit.
    pub fn from_path(path: &[PathPoint], jig: Jig) -> Result<Self, ServoError> {
        let horn_path = HornPath::new(path);
        let commands = servo_commands::list_commands(jig.side);
        let first_command_seconds = horn_path.find_start_time(&commands)?;
        let rests = horn_path.find_rests(&commands, first_command_seconds, COMMAND_INTERVAL);
        let [gain, hysteresis] =
            fit_gain_and_hysteresis(&commands, &rests).ok_or(ServoError::StepMismatch)?;
        let large_steps = horn_path.find_large_steps(&rests);
        let frame_rate = horn_path.frame_rate();
        let too_few_frames = ServoError::TooFewFrames { rate: frame_rate };
        let groups = large_steps.each_ref().map(Vec::as_slice);
        let fit = Rates::fit(groups, jig.rotor_time_constant).ok_or(too_few_frames)?;
        let [rate_ccw, rate_cw] = fit.rates;
        let rate = fit.propagate_error((rate_ccw + rate_cw) / 2.0, [0.5, 0.5]);
        if rate.value > MAX_OWN_RATE_FRACTION * jig.slew {
            return Err(ServoError::AtSlewLimit {
                rate: rate.value,
                slew: jig.slew,
            });
        }
        let rates = [
            fit.propagate_error(rate_ccw, [1.0, 0.0]),
            fit.propagate_error(rate_cw, [0.0, 1.0]),
        ];
        Ok(Self {
            gain,
            hysteresis,
            dead_band: horn_path.find_dead_band(&commands, &rests, gain.value),
            rate: add_systematic_errors(rate),
            rates: rates.map(add_systematic_errors),
            rotor_time_constant: fit.rotor_time_constant,
            first_command_seconds,
            frame_rate,
            large_steps,
            expected_time_constant: jig.rotor_time_constant,
        })
    }

    /// Computes the stall torque from two measurements: this one without a load, and `loaded` with a load of `torque`.
    /// The result has the unit of `torque`. The rate falls linearly with the torque. The load acts in only one
    /// direction: the one in which it slows the servo down more.
    ///
    /// # Errors
    /// Fails if there are too few frames, if the load does not slow the servo down, or if `loaded` seems to be the
    /// measurement without the load.
    pub fn compute_stall_torque(&self, loaded: &Self, torque: f64) -> Result<Estimate, ServoError> {
        let too_few_frames = ServoError::TooFewFrames {
            rate: self.frame_rate.min(loaded.frame_rate),
        };
        let rate_loss = |direction: usize| -> Result<Estimate, ServoError> {
            let groups = [self, loaded].map(|servo| &servo.large_steps[direction][..]);
            let fit = Rates::fit(groups, self.expected_time_constant).ok_or(too_few_frames)?;
            let [free_rate, loaded_rate] = fit.rates;
            let gradient = [loaded_rate / free_rate.powi(2), -1.0 / free_rate];
            Ok(fit.propagate_error(1.0 - loaded_rate / free_rate, gradient))
        };
        let ccw_loss = rate_loss(0)?;
        let cw_loss = rate_loss(1)?;
        let loss = match cw_loss.value > ccw_loss.value {
            true => cw_loss,
            false => ccw_loss,
        };
        let is_significant = loss.value > 2.0 * loss.standard_error;
        if !is_significant {
            return Err(ServoError::LoadTooSmall {
                percent: 100.0 * loss.value,
                error: 100.0 * loss.standard_error,
            });
        }
        // A load slows one direction: if the directions differ more without it, the videos were swapped.
        let asymmetry = |servo: &Self| (servo.rates[0].value - servo.rates[1].value).abs();
        if asymmetry(self) > asymmetry(loaded) {
            return Err(ServoError::VideosSwapped);
        }
        let value = torque / loss.value;
        let relative_error = (loss.standard_error / loss.value).hypot(LOAD_SIGMA);
        Ok(Estimate::new(value, value * relative_error))
    }
}

/// Adds the errors of the camera and of the motor model to a rate.
fn add_systematic_errors(rate: Estimate) -> Estimate {
    add_relative_error(add_relative_error(rate, CAMERA_SIGMA), MOTOR_SIGMA)
}

fn add_relative_error(estimate: Estimate, relative_sigma: f64) -> Estimate {
    let error = relative_sigma * estimate.value;
    Estimate::new(estimate.value, estimate.standard_error.hypot(error))
}

/// Fits gain and hysteresis to the angles at which the horn rests in the visited poses; `None` if too few of these
/// angles are visible. Every move to one of these poses has the same length, so the horn stops in the same way.
fn fit_gain_and_hysteresis(commands: &[ServoCommand], rests: &[Rest]) -> Option<[Estimate; 2]> {
    let visits: Vec<(f64, f64, f64)> = servo_commands::visited_pose_indices()
        .filter_map(|i| {
            let (previous, current) = (commands[i - 1].pulse_angle(), commands[i].pulse_angle());
            let direction = (current - previous).signum();
            (current != previous).then_some((current, direction, rests[i].angle?))
        })
        .collect();
    let start = [visits.first()?.2, 1.0, 0.0];
    let residuals = |parameters: &[f64]| -> Vec<f64> {
        let residual = |(commanded, direction, rest): &(f64, f64, f64)| {
            parameters[0] + parameters[1] * commanded - parameters[2] * direction / 2.0 - rest
        };
        visits.iter().map(residual).collect()
    };
    let fit = least_squares::fit(&start, residuals)?;
    let degrees_of_freedom = visits.len().checked_sub(start.len()).filter(|n| *n > 0)?;
    let variance = fit.sum_of_squares / degrees_of_freedom as f64;
    let standard_error = |i: usize| {
        small_sample_factor(degrees_of_freedom) * (variance * fit.covariance[(i, i)]).sqrt()
    };
    let gain = Estimate::new(fit.parameters[1], standard_error(1));
    let gain = add_relative_error(gain, CAMERA_SIGMA);
    let hysteresis_error = standard_error(2) / gain.value.abs();
    let hysteresis = Estimate::new(fit.parameters[2] / gain.value, hysteresis_error);
    Some([gain, hysteresis])
}

/// The horn's rest after a command.
struct Rest {
    /// Indices of the frames that show the rest.
    frames: Range<usize>,
    /// Mean angle of the horn, deg; `None` if no frame shows the rest.
    angle: Option<f64>,
}

/// Computes the fraction of the rest angles' variance that the commands leave unexplained; `None` if too few rests are
/// visible.
fn unexplained_fraction(commands: &[ServoCommand], rests: &[Rest]) -> Option<f64> {
    let command_and_rest =
        |(command, rest): (&ServoCommand, &Rest)| Some((command.pulse_angle(), rest.angle?));
    let pairs = commands.iter().zip(rests).filter_map(command_and_rest);
    let pairs: Vec<(f64, f64)> = pairs.collect();
    if (pairs.len() as f64) < MIN_VISIBLE_FRACTION * commands.len() as f64 {
        return None;
    }
    let mean = |component: fn(&(f64, f64)) -> f64| {
        pairs.iter().map(component).sum::<f64>() / pairs.len() as f64
    };
    let (mean_command, mean_rest) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let (mut command_square_sum, mut product_sum, mut rest_square_sum) = (0.0, 0.0, 0.0);
    for (a, b) in &pairs {
        let (a, b) = (a - mean_command, b - mean_rest);
        command_square_sum += a * a;
        product_sum += a * b;
        rest_square_sum += b * b;
    }
    Some(1.0 - product_sum * product_sum / (command_square_sum * rest_square_sum).max(1e-9))
}

/// The horn's angles in a video, and their prefix sums.
struct HornPath {
    /// The time, s, and the angle, deg, of each frame.
    angles: Vec<(f64, f64)>,
    /// The sum of the angles of all frames before each frame, deg.
    prefix_sums: Vec<f64>,
}

impl HornPath {
    fn new(path: &[PathPoint]) -> Self {
        let timed_angle = |point: &PathPoint| (point.seconds, point.pose.heading.to_degrees());
        let angles: Vec<_> = path.iter().map(timed_angle).collect();
        let mut prefix_sums = vec![0.0];
        for (i, (_, angle)) in angles.iter().enumerate() {
            prefix_sums.push(prefix_sums[i] + angle);
        }
        Self {
            angles,
            prefix_sums,
        }
    }

    /// Computes the frames per second from the median interval, which missing frames hardly change.
    fn frame_rate(&self) -> f64 {
        let intervals = self.angles.windows(2).map(|pair| pair[1].0 - pair[0].0);
        mean::median(intervals.collect()).map_or(0.0, |interval| 1.0 / interval)
    }

    /// Finds the horn's rest after each command. The first command is at `first_command_seconds`, and the command
    /// interval is `interval`, s.
    fn find_rests(
        &self,
        commands: &[ServoCommand],
        first_command_seconds: f64,
        interval: f64,
    ) -> Vec<Rest> {
        let rest_after = |command_index: usize| {
            let [from, to] = REST_FRACTIONS.map(|fraction| {
                let time = first_command_seconds + interval * (command_index as f64 + fraction);
                self.angles.partition_point(|(seconds, _)| *seconds < time)
            });
            let sum = self.prefix_sums[to] - self.prefix_sums[from];
            Rest {
                frames: from..to,
                angle: (from < to).then(|| sum / (to - from) as f64),
            }
        };
        (0..commands.len()).map(rest_after).collect()
    }

    /// Finds the time of the first command, s, that minimises the unexplained fraction. Returns the time and the
    /// fraction; `None` if no time makes enough rests visible.
    fn find_best_start_time(&self, commands: &[ServoCommand], interval: f64) -> Option<(f64, f64)> {
        let (first, last) = (self.angles.first()?.0, self.angles.last()?.0);
        let end = last - interval * (commands.len() as f64 - 1.0 + REST_FRACTIONS[0]);
        let step_count =
            ((end - first + interval) / (SEARCH_STEP_FRACTION * interval)).max(0.0) as usize;
        let candidates = (0..=step_count).filter_map(|i| {
            let seconds = first - interval + i as f64 * SEARCH_STEP_FRACTION * interval;
            let rests = self.find_rests(commands, seconds, interval);
            Some((seconds, unexplained_fraction(commands, &rests)?))
        });
        candidates.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Finds the time of the first command, s.
    fn find_start_time(&self, commands: &[ServoCommand]) -> Result<f64, ServoError> {
        let angle_values = || self.angles.iter().map(|(_, angle)| *angle);
        let max_angle = angle_values().fold(f64::MIN, f64::max);
        let turn = max_angle - angle_values().fold(f64::MAX, f64::min);
        if turn <= MIN_TURN {
            return Err(ServoError::NoTurn {
                turn: turn.max(0.0),
            });
        }
        let is_explained = |(_, unexplained): &(f64, f64)| *unexplained < MAX_UNEXPLAINED_FRACTION;
        let best = self.find_best_start_time(commands, COMMAND_INTERVAL);
        if let Some((first_command_seconds, _)) = best.filter(is_explained) {
            return Ok(self.refine_start_time(commands, first_command_seconds));
        }
        for multiple in INTERVAL_MULTIPLES {
            let best = self.find_best_start_time(commands, multiple * COMMAND_INTERVAL);
            if best.is_some_and(|best| is_explained(&best)) {
                return Err(ServoError::WrongStepInterval { ratio: multiple });
            }
        }
        let seconds = self.angles[self.angles.len() - 1].0 - self.angles[0].0;
        let needed = COMMAND_INTERVAL * commands.len() as f64;
        Err(match seconds < needed - COMMAND_INTERVAL {
            true => ServoError::TooShort { seconds, needed },
            false => ServoError::StepMismatch,
        })
    }

    /// Refines the time of the first command, s, from the times at which the large steps are half complete.
    fn refine_start_time(&self, commands: &[ServoCommand], first_command_seconds: f64) -> f64 {
        let rests = self.find_rests(commands, first_command_seconds, COMMAND_INTERVAL);
        let estimate_from_step = |i: usize| {
            let [before, after] = [&rests[i - 1], &rests[i]];
            let half_way_angle = (before.angle? + after.angle?) / 2.0;
            let pairs = self.angles[before.frames.start..after.frames.end].windows(2);
            let mut crossings =
                pairs.filter(|pair| (pair[0].1 < half_way_angle) != (pair[1].1 < half_way_angle));
            let pair = crossings.next()?;
            let ((start_time, start_angle), (end_time, end_angle)) = (pair[0], pair[1]);
            let fraction = (half_way_angle - start_angle) / (end_angle - start_angle);
            let time = start_time + fraction * (end_time - start_time);
            Some(time - COMMAND_INTERVAL * i as f64 - HALF_WAY_SECONDS)
        };
        let estimates = servo_commands::large_step_indices().filter_map(estimate_from_step);
        mean::median(estimates.collect()).unwrap_or(first_command_seconds)
    }

    /// Finds the large steps, counter-clockwise and clockwise.
    fn find_large_steps(&self, rests: &[Rest]) -> [Vec<LargeStep>; 2] {
        let mut steps = [Vec::new(), Vec::new()];
        for i in servo_commands::large_step_indices() {
            let [before, after] = [&rests[i - 1], &rests[i]];
            let (Some(from), Some(to)) = (before.angle, after.angle) else {
                continue;
            };
            let angles = self.angles[before.frames.end..after.frames.end].iter();
            let angles = angles.map(|(time, angle)| (*time, angle - from));
            steps[usize::from(to < from)].push(LargeStep::new(angles, to - from));
        }
        steps
    }

    /// Finds the dead band from the small steps: in each step, the servo's movement falls short of the commanded
    /// movement by the width of the dead band.
    fn find_dead_band(&self, commands: &[ServoCommand], rests: &[Rest], gain: f64) -> DeadBand {
        // Sums up the squared deviations of the frames from the mean angle of their rest.
        let (mut squares, mut degrees_of_freedom, mut frame_count) = (0.0, 0usize, 0usize);
        for rest in rests {
            let Some(mean_angle) = rest.angle else {
                continue;
            };
            let square = |(_, angle): &(f64, f64)| (angle - mean_angle).powi(2);
            let angles = self.angles[rest.frames.clone()].iter();
            squares += angles.map(square).sum::<f64>();
            degrees_of_freedom += rest.frames.len() - 1;
            frame_count += rest.frames.len();
        }
        let frames_per_rest = frame_count as f64 / rests.len() as f64;
        let variance = squares / degrees_of_freedom.max(1) as f64;
        let movement_error = (2.0 * variance / frames_per_rest.max(1.0)).sqrt() / gain.abs();
        let min_movement = MIN_MOVEMENT.max(MIN_MOVEMENT_SIGMAS * movement_error);
        let (mut lost_angles, mut largest_ignored_step, mut has_moved) =
            (Vec::new(), 0.0f64, false);
        for i in servo_commands::small_step_indices() {
            let (Some(from), Some(to)) = (rests[i - 1].angle, rests[i].angle) else {
                continue;
            };
            let commanded = commands[i].pulse_angle() - commands[i - 1].pulse_angle();
            let movement = (to - from) / gain * commanded.signum();
            let had_moved = std::mem::replace(&mut has_moved, movement > min_movement);
            if !has_moved {
                largest_ignored_step = largest_ignored_step.max(commanded.abs());
            } else if had_moved && movement < MAX_SMALL_MOVEMENT {
                // After a movement, the servo stands at the edge of its dead band; otherwise it may stand anywhere
                // in the dead band.
                lost_angles.push(commanded.abs() - movement);
            }
        }
        let width = (lost_angles.len() > 1).then(|| {
            let mean = mean::compute_mean(&[WalkValues {
                cycles: lost_angles,
                systematic_error: 0.0,
            }]);
            // Overshoot and noise may exceed a narrow dead band, but robot.toml allows no negative width.
            let width = mean.value.max(0.0);
            Estimate::new(width, mean.standard_error.hypot(DEAD_BAND_SIGMA))
        });
        DeadBand {
            width,
            largest_ignored_step,
        }
    }
}
