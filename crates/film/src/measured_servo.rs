//! A servo measured in a film: the angle that it turns for its pulses, its rate, and the small steps that it ignores.
//!
//! The servo gets the steps of [`crate::orders`] at even intervals, but the time of the first step in the film is
//! unknown. It is found from the angles at which the horn rests, which must depend linearly on the orders.

use crate::figure::Figure;
use crate::least_squares;
use crate::mean::{self, WalkValues, small_sample_factor};
use crate::orders::{self, ORDER_INTERVAL, Order};
use crate::path::PathPoint;
use crate::rates::{LargeStep, Rates};
use crate::servo_trouble::ServoTrouble;

/// Beginning and end of the time after an order in which the horn rests, as shares of [`ORDER_INTERVAL`].
const REST_SHARES: [f64; 2] = [0.45, 0.92];
/// Step of the search for the time of the first order, as a share of the time from one order to the next.
const SEARCH_STEP_SHARE: f64 = 0.02;
/// Smallest share of the orders whose rest must be visible.
const MIN_VISIBLE_SHARE: f64 = 0.9;
/// Time from an order to the moment at which half of its large step is complete, s.
const HALF_WAY_SECONDS: f64 = 0.1;
/// Smallest turn that shows a moving servo, deg.
const MIN_TURN: f64 = 5.0;
/// Largest share of the variance of the rest angles that the orders may leave unexplained.
const MAX_UNEXPLAINED_SHARE: f64 = 0.02;
/// Other times from one order to the next that are tried, as multiples of the planned time.
const INTERVAL_MULTIPLES: [f64; 5] = [0.25, 0.5, 2.0, 4.0, 8.0];
/// Largest rate that counts as the servo's own, as a share of the slew limit.
const MAX_OWN_RATE_SHARE: f64 = 0.8;
/// Standard error that the camera causes in an angle, as a share.
const CAMERA_SIGMA: f64 = 0.002;
/// Standard error that the simple motor model causes in a rate, as a share.
const MOTOR_SIGMA: f64 = 0.003;
/// Smallest angle that counts as a movement, deg.
const MIN_MOVEMENT: f64 = 0.05;
/// Smallest angle that counts as a movement, as a multiple of its standard error.
const MIN_MOVEMENT_SIGMAS: f64 = 3.0;
/// Largest movement of a small step that is used for the dead band, deg: after a larger one the servo overshoots.
const MAX_SMALL_MOVEMENT: f64 = 1.6;
/// Standard error of the dead band's width, deg: the servo does not always stop at its edge.
const DEAD_BAND_SIGMA: f64 = 0.06;
/// Standard error of the load's torque, as a share: half a millimetre in a lever arm of 20 mm.
const LOAD_SIGMA: f64 = 0.025;

/// The known values of the jig, which holds a servo under the camera with the sheet's card on its horn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jig {
    /// Side of neutral on which the poses are: 1 for counter-clockwise, -1 for clockwise.
    pub side: f64,
    /// Slew limit of the orders, deg/s.
    pub slew: f64,
    /// Expected time constant of the rotor, s.
    pub spin_up: f64,
}

/// The dead band that small steps show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeadBand {
    /// Width, nominal deg; `None` if too few small steps moved the servo.
    pub width: Option<Figure>,
    /// Largest small step that moved nothing, nominal deg; 0 if all steps moved the servo.
    pub largest_ignored_step: f64,
}

/// A measured servo. A nominal deg is a deg by the pulse scale of robot.toml.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredServo {
    /// Angle that the servo turns per nominal deg; negative if it turns in the opposite direction.
    pub gain: Figure,
    /// Difference of the angles at which the servo stops after approaching from either side, nominal deg.
    pub hysteresis: Figure,
    /// The dead band.
    pub dead_band: DeadBand,
    /// Mean of the rates in both directions, deg/s.
    pub rate: Figure,
    /// Rates counter-clockwise and clockwise, deg/s.
    pub rates: [Figure; 2],
    /// Time constant of the rotor, s; `None` if the film has too few pictures for it.
    pub spin_up: Option<Figure>,
    /// Time of the first order, s.
    pub first_order_seconds: f64,
    /// Pictures per second.
    pub picture_rate: f64,
    /// The large steps, counter-clockwise and clockwise.
    large_steps: [Vec<LargeStep>; 2],
    /// Expected time constant of the rotor, s.
    expected_spin_up: f64,
}

impl MeasuredServo {
    /// Measures a servo from the path of the card on its horn.
    ///
    /// # Errors
    /// Fails if the horn does not turn as ordered or is visible too rarely, or if the rate is near the slew limit.
    pub fn of(path: &[PathPoint], jig: Jig) -> Result<Self, ServoTrouble> {
        let horn_path = HornPath::new(path);
        let orders = orders::orders(jig.side);
        let first_order_seconds = horn_path.find_first_order(&orders)?;
        let rests: Vec<Option<f64>> = (0..orders.len())
            .map(|i| horn_path.rest_angle(first_order_seconds, ORDER_INTERVAL, i))
            .collect();
        let [gain, hysteresis] = fit_gain(&orders, &rests).ok_or(ServoTrouble::StepMismatch)?;
        let large_steps = horn_path.large_steps(first_order_seconds, &rests);
        let too_few_pictures = ServoTrouble::TooFewPictures {
            rate: horn_path.picture_rate(),
        };
        let groups: Vec<&[LargeStep]> = large_steps.iter().map(Vec::as_slice).collect();
        let fit = Rates::fit(&groups, jig.spin_up).ok_or(too_few_pictures)?;
        let (rate_ccw, rate_cw) = (fit.rates[0], fit.rates[1]);
        let rate = fit.propagate_error((rate_ccw + rate_cw) / 2.0, &[0.5, 0.5]);
        if rate.value > MAX_OWN_RATE_SHARE * jig.slew {
            return Err(ServoTrouble::AtSlewLimit {
                rate: rate.value,
                slew: jig.slew,
            });
        }
        Ok(Self {
            gain,
            hysteresis,
            dead_band: horn_path.find_dead_band(first_order_seconds, &orders, &rests, gain.value),
            rate: add_model_error(rate),
            rates: [
                fit.propagate_error(rate_ccw, &[1.0, 0.0]),
                fit.propagate_error(rate_cw, &[0.0, 1.0]),
            ]
            .map(add_model_error),
            spin_up: fit.spin_up,
            first_order_seconds,
            picture_rate: horn_path.picture_rate(),
            large_steps,
            expected_spin_up: jig.spin_up,
        })
    }

    /// Computes the stall torque, in the unit of `torque`, from this measurement and that of the same servo under a
    /// load of `torque`: the rate falls linearly with the torque. The load pulls in one direction only: the
    /// direction in which it slows the servo down more.
    ///
    /// # Errors
    /// Fails if there are too few pictures, if the load does not slow the servo down, or if `loaded` seems to be
    /// the measurement without the load.
    pub fn stall_torque(&self, loaded: &Self, torque: f64) -> Result<Figure, ServoTrouble> {
        let too_few_pictures = ServoTrouble::TooFewPictures {
            rate: self.picture_rate.min(loaded.picture_rate),
        };
        let loss_in = |direction: usize| {
            let fit = Rates::fit(
                &[&self.large_steps[direction], &loaded.large_steps[direction]],
                self.expected_spin_up,
            )?;
            let (free_rate, loaded_rate) = (fit.rates[0], fit.rates[1]);
            Some(fit.propagate_error(
                1.0 - loaded_rate / free_rate,
                &[loaded_rate / free_rate.powi(2), -1.0 / free_rate],
            ))
        };
        let losses = [
            loss_in(0).ok_or(too_few_pictures)?,
            loss_in(1).ok_or(too_few_pictures)?,
        ];
        let loss = losses[usize::from(losses[1].value > losses[0].value)];
        if !loss.is_significantly_above(0.0) {
            return Err(ServoTrouble::LoadTooSmall {
                percent: 100.0 * loss.value,
                error: 100.0 * loss.error,
            });
        }
        // Only a load makes one direction slower than the other.
        let asymmetry = |servo: &Self| (servo.rates[0].value - servo.rates[1].value).abs();
        if asymmetry(self) > asymmetry(loaded) {
            return Err(ServoTrouble::FilmsSwapped);
        }
        let value = torque / loss.value;
        Ok(Figure {
            value,
            error: value * (loss.error / loss.value).hypot(LOAD_SIGMA),
        })
    }
}

/// Adds the error of the camera to a figure.
fn add_camera_error(figure: Figure) -> Figure {
    Figure {
        error: figure.error.hypot(CAMERA_SIGMA * figure.value),
        ..figure
    }
}

/// Adds the errors of the camera and of the motor model to a rate.
fn add_model_error(rate: Figure) -> Figure {
    let Figure { value, error } = add_camera_error(rate);
    Figure {
        value,
        error: error.hypot(MOTOR_SIGMA * value),
    }
}

/// Fits gain and hysteresis to the angles at which the horn rests at the visited poses; `None` if too few of them are
/// visible. All these poses are reached by moves of the same length, so the horn stops in the same way.
fn fit_gain(orders: &[Order], rests: &[Option<f64>]) -> Option<[Figure; 2]> {
    let visits: Vec<(f64, f64, f64)> = orders::visit_indices()
        .filter_map(|i| {
            let (previous, current) = (orders[i - 1].pulse_angle(), orders[i].pulse_angle());
            (current != previous).then_some((current, (current - previous).signum(), rests[i]?))
        })
        .collect();
    let start = [visits.first()?.2, 1.0, 0.0];
    let residuals = |parameters: &[f64]| -> Vec<f64> {
        let residual_of = |(ordered, direction, rest): &(f64, f64, f64)| {
            parameters[0] + parameters[1] * ordered - parameters[2] * direction / 2.0 - rest
        };
        visits.iter().map(residual_of).collect()
    };
    let fit = least_squares::fit(&start, residuals)?;
    let degrees_of_freedom = visits.len().checked_sub(start.len()).filter(|n| *n > 0)?;
    let variance = fit.sum_of_squares / degrees_of_freedom as f64;
    let error_of = |i: usize| {
        small_sample_factor(degrees_of_freedom) * (variance * fit.covariance[(i, i)]).sqrt()
    };
    let gain = add_camera_error(Figure {
        value: fit.parameters[1],
        error: error_of(1),
    });
    let hysteresis = Figure {
        value: fit.parameters[2] / gain.value,
        error: error_of(2) / gain.value.abs(),
    };
    Some([gain, hysteresis])
}

/// The horn's angles in a film, and their prefix sums.
struct HornPath {
    /// The time, s, and the angle, deg, of each picture.
    angles: Vec<(f64, f64)>,
    /// The sum of the angles of all pictures before each picture, deg.
    prefix_sums: Vec<f64>,
}

impl HornPath {
    fn new(path: &[PathPoint]) -> Self {
        let angle_of = |point: &PathPoint| (point.seconds, point.place.heading.to_degrees());
        let angles: Vec<_> = path.iter().map(angle_of).collect();
        let mut prefix_sums = vec![0.0];
        for (i, (_, angle)) in angles.iter().enumerate() {
            prefix_sums.push(prefix_sums[i] + angle);
        }
        Self {
            angles,
            prefix_sums,
        }
    }

    /// Pictures per second, from the median interval, which missing pictures hardly change.
    fn picture_rate(&self) -> f64 {
        let intervals = self.angles.windows(2).map(|pair| pair[1].0 - pair[0].0);
        let mut intervals: Vec<f64> = intervals.collect();
        intervals.sort_by(f64::total_cmp);
        intervals
            .get(intervals.len() / 2)
            .map_or(0.0, |interval| 1.0 / interval)
    }

    /// The indices of the pictures in a time interval.
    fn indices_between(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let index_at = |time: f64| self.angles.partition_point(|(seconds, _)| *seconds < time);
        index_at(from)..index_at(to)
    }

    /// The indices of the pictures in which the horn rests after an order, if the first order is at
    /// `first_order_seconds` and the interval between orders is `interval`, s.
    fn rest_indices(
        &self,
        first_order_seconds: f64,
        interval: f64,
        order_index: usize,
    ) -> std::ops::Range<usize> {
        let [from, to] =
            REST_SHARES.map(|share| first_order_seconds + interval * (order_index as f64 + share));
        self.indices_between(from, to)
    }

    /// The mean angle at which the horn rests after an order, deg; `None` if no picture shows it.
    fn rest_angle(
        &self,
        first_order_seconds: f64,
        interval: f64,
        order_index: usize,
    ) -> Option<f64> {
        let indices = self.rest_indices(first_order_seconds, interval, order_index);
        let sum = self.prefix_sums[indices.end] - self.prefix_sums[indices.start];
        (!indices.is_empty()).then(|| sum / indices.len() as f64)
    }

    /// The share of the variance of the rest angles that the orders do not explain, if the first order is at
    /// `first_order_seconds`; `None` if too few rests are visible.
    fn unexplained_share(
        &self,
        orders: &[Order],
        first_order_seconds: f64,
        interval: f64,
    ) -> Option<f64> {
        let pair_of = |i: usize| {
            Some((
                orders[i].pulse_angle(),
                self.rest_angle(first_order_seconds, interval, i)?,
            ))
        };
        let pairs: Vec<(f64, f64)> = (0..orders.len()).filter_map(pair_of).collect();
        if (pairs.len() as f64) < MIN_VISIBLE_SHARE * orders.len() as f64 {
            return None;
        }
        let mean_of = |component: fn(&(f64, f64)) -> f64| {
            pairs.iter().map(component).sum::<f64>() / pairs.len() as f64
        };
        let (mean_order, mean_rest) = (mean_of(|pair| pair.0), mean_of(|pair| pair.1));
        let (mut order_square_sum, mut product_sum, mut rest_square_sum) = (0.0, 0.0, 0.0);
        for (a, b) in &pairs {
            let (a, b) = (a - mean_order, b - mean_rest);
            order_square_sum += a * a;
            product_sum += a * b;
            rest_square_sum += b * b;
        }
        Some(1.0 - product_sum * product_sum / (order_square_sum * rest_square_sum).max(1e-9))
    }

    /// Finds the time of the first order, s, for which the unexplained share is smallest; returns both.
    fn find_best_first_order(&self, orders: &[Order], interval: f64) -> Option<(f64, f64)> {
        let (first, last) = (self.angles.first()?.0, self.angles.last()?.0);
        let end = last - interval * (orders.len() as f64 - 1.0 + REST_SHARES[0]);
        let try_count =
            ((end - first + interval) / (SEARCH_STEP_SHARE * interval)).max(0.0) as usize;
        (0..=try_count)
            .map(|i| first - interval + i as f64 * SEARCH_STEP_SHARE * interval)
            .filter_map(|first_order_seconds| {
                Some((
                    self.unexplained_share(orders, first_order_seconds, interval)?,
                    first_order_seconds,
                ))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(share, first_order_seconds)| (first_order_seconds, share))
    }

    /// Finds the time of the first order, s.
    fn find_first_order(&self, orders: &[Order]) -> Result<f64, ServoTrouble> {
        let angle_values = || self.angles.iter().map(|(_, angle)| *angle);
        let turn =
            angle_values().fold(f64::MIN, f64::max) - angle_values().fold(f64::MAX, f64::min);
        if turn <= MIN_TURN {
            return Err(ServoTrouble::NoTurn {
                turn: turn.max(0.0),
            });
        }
        let is_explained =
            |(_, unexplained_share): &(f64, f64)| *unexplained_share < MAX_UNEXPLAINED_SHARE;
        if let Some((first_order_seconds, _)) = self
            .find_best_first_order(orders, ORDER_INTERVAL)
            .filter(is_explained)
        {
            return Ok(self.refine_first_order(first_order_seconds));
        }
        for multiple in INTERVAL_MULTIPLES {
            if self
                .find_best_first_order(orders, multiple * ORDER_INTERVAL)
                .is_some_and(|best| is_explained(&best))
            {
                return Err(ServoTrouble::WrongStepInterval { ratio: multiple });
            }
        }
        let seconds = self.angles[self.angles.len() - 1].0 - self.angles[0].0;
        let needed = ORDER_INTERVAL * orders.len() as f64;
        Err(match seconds < needed - ORDER_INTERVAL {
            true => ServoTrouble::TooShort { seconds, needed },
            false => ServoTrouble::StepMismatch,
        })
    }

    /// Refines the time of the first order, s, from the times at which the large steps are half complete.
    fn refine_first_order(&self, first_order_seconds: f64) -> f64 {
        let estimate_from_step = |i: usize| {
            let (from, to) = (
                self.rest_angle(first_order_seconds, ORDER_INTERVAL, i - 1)?,
                self.rest_angle(first_order_seconds, ORDER_INTERVAL, i)?,
            );
            let middle = (from + to) / 2.0;
            let indices = self
                .rest_indices(first_order_seconds, ORDER_INTERVAL, i - 1)
                .start
                ..self
                    .rest_indices(first_order_seconds, ORDER_INTERVAL, i)
                    .end;
            let pairs = self.angles[indices].windows(2);
            let mut crossings = pairs.filter(|pair| (pair[0].1 < middle) != (pair[1].1 < middle));
            let pair = crossings.next()?;
            let ((start_time, start_angle), (end_time, end_angle)) = (pair[0], pair[1]);
            let share = (middle - start_angle) / (end_angle - start_angle);
            let time = start_time + share * (end_time - start_time);
            Some(time - ORDER_INTERVAL * i as f64 - HALF_WAY_SECONDS)
        };
        let mut estimates: Vec<f64> = orders::large_step_indices()
            .filter_map(estimate_from_step)
            .collect();
        estimates.sort_by(f64::total_cmp);
        estimates
            .get(estimates.len() / 2)
            .copied()
            .unwrap_or(first_order_seconds)
    }

    /// The large steps, counter-clockwise and clockwise.
    fn large_steps(&self, first_order_seconds: f64, rests: &[Option<f64>]) -> [Vec<LargeStep>; 2] {
        let mut steps = [Vec::new(), Vec::new()];
        for i in orders::large_step_indices() {
            let (Some(from), Some(to)) = (rests[i - 1], rests[i]) else {
                continue;
            };
            let indices = self
                .rest_indices(first_order_seconds, ORDER_INTERVAL, i - 1)
                .end
                ..self
                    .rest_indices(first_order_seconds, ORDER_INTERVAL, i)
                    .end;
            let angles = self.angles[indices]
                .iter()
                .map(|(time, angle)| (*time, angle - from));
            steps[usize::from(to < from)].push(LargeStep::new(angles, to - from));
        }
        steps
    }

    /// Finds the dead band from the small steps: the servo turns less than ordered by the width of the dead band.
    fn find_dead_band(
        &self,
        first_order_seconds: f64,
        orders: &[Order],
        rests: &[Option<f64>],
        gain: f64,
    ) -> DeadBand {
        // Deviations of single pictures from the mean of their rest.
        let (mut squares, mut degrees_of_freedom, mut picture_count) = (0.0, 0usize, 0usize);
        for (i, rest) in rests.iter().enumerate() {
            let rest_angles =
                &self.angles[self.rest_indices(first_order_seconds, ORDER_INTERVAL, i)];
            let Some(rest) = rest else { continue };
            squares += rest_angles
                .iter()
                .map(|(_, angle)| (angle - rest).powi(2))
                .sum::<f64>();
            degrees_of_freedom += rest_angles.len().saturating_sub(1);
            picture_count += rest_angles.len();
        }
        let pictures_per_rest = picture_count as f64 / rests.len() as f64;
        let variance = squares / degrees_of_freedom.max(1) as f64;
        let error = (2.0 * variance / pictures_per_rest.max(1.0)).sqrt() / gain.abs();
        let min_movement = MIN_MOVEMENT.max(MIN_MOVEMENT_SIGMAS * error);
        let (mut lost_angles, mut largest_ignored_step, mut has_moved) =
            (Vec::new(), 0.0f64, false);
        for i in orders::small_step_indices() {
            let (Some(from), Some(to)) = (rests[i - 1], rests[i]) else {
                continue;
            };
            let ordered = orders[i].pulse_angle() - orders[i - 1].pulse_angle();
            let movement = (to - from) / gain * ordered.signum();
            let had_moved = std::mem::replace(&mut has_moved, movement > min_movement);
            if !has_moved {
                largest_ignored_step = largest_ignored_step.max(ordered.abs());
            } else if had_moved && movement < MAX_SMALL_MOVEMENT {
                // After a movement the servo stands at the edge of its dead band; before one, it may be anywhere
                // within it.
                lost_angles.push(ordered.abs() - movement);
            }
        }
        let width = (lost_angles.len() > 1).then(|| {
            let mean = mean::mean_of_walks(&[WalkValues {
                cycles: lost_angles,
                systematic_error: 0.0,
            }]);
            Figure {
                value: mean.value,
                error: mean.standard_error.hypot(DEAD_BAND_SIGMA),
            }
        });
        DeadBand {
            width,
            largest_ignored_step,
        }
    }
}
