//! A servo measured in a film: the angle that it turns for its pulses, its rate, and the small steps that it
//! ignores.
//!
//! The servo gets the steps of [`crate::orders`] at even intervals, but their time in the film is unknown. It is
//! found by the angles at which the horn rests, which must depend linearly on the orders.

use crate::figure::Figure;
use crate::least;
use crate::mean::{self, widening};
use crate::orders::{self, Order, PAUSE};
use crate::path::PathPoint;
use crate::spin::{Rates, Step};
use crate::turns_trouble::TurnsTrouble;

/// Part of an order's time in which the horn rests, as shares of that time.
const REST_SHARES: [f64; 2] = [0.45, 0.92];
/// Step of the search for the time of the first order, as a share of the time from one order to the next.
const SEARCH_STEP: f64 = 0.02;
/// Smallest share of the orders whose rest must be visible.
const MIN_SEEN_SHARE: f64 = 0.9;
/// Time from an order to half of its large step, s.
const HALF_WAY_SECONDS: f64 = 0.1;
/// Smallest turn that shows a moving servo, deg.
const MIN_TURN: f64 = 5.0;
/// Largest share of the rests' variance that the orders do not explain.
const MAX_UNEXPLAINED: f64 = 0.02;
/// Other times from one order to the next that are tried, as multiples of the planned time.
const MULTIPLES: [f64; 5] = [0.25, 0.5, 2.0, 4.0, 8.0];
/// Largest share of the slew limit up to which a rate is the servo's own.
const MAX_OWN_RATE: f64 = 0.8;
/// Standard error of an angle by the camera, as a share.
const CAMERA_SIGMA: f64 = 0.002;
/// Standard error of a rate because the motor model is simple, as a share: a real motor does not follow it exactly.
const MOTOR_SIGMA: f64 = 0.003;
/// Smallest angle that counts as a movement, deg.
const MIN_MOVEMENT: f64 = 0.05;
/// Smallest angle that counts as a movement, as a multiple of its standard error.
const MOVED_SIGMAS: f64 = 3.0;
/// Largest movement of a small step that is used for the dead band, deg: after a larger one the servo overshoots.
const MAX_SMALL_MOVEMENT: f64 = 1.6;
/// Standard error of the dead band's width, deg: the servo does not always stop at its edge.
const DEAD_BAND_ERROR: f64 = 0.06;
/// Standard error of the load's torque, as a share: half a millimetre in a lever of 20.
const LOAD_SIGMA: f64 = 0.025;

/// The known values of the jig.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jig {
    /// Side of neutral on which the poses are: 1 for counter-clockwise, -1 for clockwise.
    pub way: f64,
    /// Slew limit of the orders, deg/s.
    pub slew: f64,
    /// Expected time constant of the rotor, s.
    pub spin_up: f64,
}

/// The dead band that small steps show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeadBand {
    /// Width, in robot.toml's deg; `None` if no step was large enough.
    pub width: Option<Figure>,
    /// Largest small step that moved nothing, in robot.toml's deg; 0 if all steps moved the servo.
    pub largest_ignored_step: f64,
}

/// A measured servo.
#[derive(Debug, Clone, PartialEq)]
pub struct Turns {
    /// Angle that the servo turns per deg of robot.toml; negative if it turns in the opposite direction.
    pub gain: Figure,
    /// Difference of the angles at which the servo stops after approaching from either side, in robot.toml's deg.
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
    pub begin: f64,
    /// Pictures per second.
    pub pictures: f64,
    /// The large steps, counter-clockwise and clockwise.
    steps: [Vec<Step>; 2],
    /// Expected time constant of the rotor, s.
    expected: f64,
}

impl Turns {
    /// Measures a servo by the path of the card on its horn.
    ///
    /// # Errors
    /// Fails if the horn does not turn as ordered or is visible too rarely, or if the rate is near the slew limit.
    pub fn of(path: &[PathPoint], jig: Jig) -> Result<Self, TurnsTrouble> {
        let horn_path = Path::new(path);
        let orders = orders::orders(jig.way);
        let begin = horn_path.find_begin(&orders)?;
        let rests: Vec<Option<f64>> = (0..orders.len())
            .map(|i| horn_path.rest_angle(begin, PAUSE, i))
            .collect();
        let [gain, hysteresis] = fit_gain(&orders, &rests).ok_or(TurnsTrouble::NotTheSteps)?;
        let steps = horn_path.large_steps(begin, &rests);
        let too_few = TurnsTrouble::FewPictures {
            rate: horn_path.rate(),
        };
        let groups: Vec<&[Step]> = steps.iter().map(Vec::as_slice).collect();
        let fit = Rates::of(&groups, jig.spin_up).ok_or(too_few)?;
        let (rate_ccw, rate_cw) = (fit.rates[0], fit.rates[1]);
        let rate = fit.figure((rate_ccw + rate_cw) / 2.0, &[0.5, 0.5]);
        if rate.value > MAX_OWN_RATE * jig.slew {
            return Err(TurnsTrouble::Ordered {
                rate: rate.value,
                slew: jig.slew,
            });
        }
        Ok(Self {
            gain,
            hysteresis,
            dead_band: horn_path.dead_band(begin, &orders, &rests, gain.value),
            rate: add_model_error(rate),
            rates: [
                fit.figure(rate_ccw, &[1.0, 0.0]),
                fit.figure(rate_cw, &[0.0, 1.0]),
            ]
            .map(add_model_error),
            spin_up: fit.spin_up,
            begin,
            pictures: horn_path.rate(),
            steps,
            expected: jig.spin_up,
        })
    }

    /// Computes the stall torque, in the unit of `torque`, from this measurement and that of the same servo under a
    /// load of `torque`: the rate falls linearly with the torque. The load pulls in one direction only: the
    /// direction in which it slows the servo down more.
    ///
    /// # Errors
    /// Fails if there are too few pictures, if the load does not slow the servo down, or if `loaded` seems to be
    /// the measurement without the load.
    pub fn stall(&self, loaded: &Self, torque: f64) -> Result<Figure, TurnsTrouble> {
        let too_few = TurnsTrouble::FewPictures {
            rate: self.pictures.min(loaded.pictures),
        };
        let loss_in = |direction: usize| {
            let fit = Rates::of(
                &[&self.steps[direction], &loaded.steps[direction]],
                self.expected,
            )?;
            let (free, slow) = (fit.rates[0], fit.rates[1]);
            Some(fit.figure(1.0 - slow / free, &[slow / free.powi(2), -1.0 / free]))
        };
        let losses = [loss_in(0).ok_or(too_few)?, loss_in(1).ok_or(too_few)?];
        let loss = losses[usize::from(losses[1].value > losses[0].value)];
        if !loss.is_above(0.0) {
            return Err(TurnsTrouble::LoadNotSeen {
                percent: 100.0 * loss.value,
                error: 100.0 * loss.error,
            });
        }
        // Only a load makes one direction slower than the other.
        let unevenness = |turns: &Self| (turns.rates[0].value - turns.rates[1].value).abs();
        if unevenness(self) > unevenness(loaded) {
            return Err(TurnsTrouble::Swapped);
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

/// Fits gain and hysteresis to the angles at which the horn rests after the visits; `None` if too few are visible.
/// All visits are reached by moves of the same length, so the horn stops in the same way.
fn fit_gain(orders: &[Order], rests: &[Option<f64>]) -> Option<[Figure; 2]> {
    let visits: Vec<(f64, f64, f64)> = orders::visits()
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
    let fit = least::fit(&start, residuals)?;
    let freedom = visits.len().checked_sub(start.len()).filter(|n| *n > 0)?;
    let variance = fit.squares / freedom as f64;
    let error_of = |i: usize| widening(freedom) * (variance * fit.covariance[(i, i)]).sqrt();
    let gain = add_camera_error(Figure {
        value: fit.at[1],
        error: error_of(1),
    });
    let hysteresis = Figure {
        value: fit.at[2] / gain.value,
        error: error_of(2) / gain.value.abs(),
    };
    Some([gain, hysteresis])
}

/// The horn's angles in a film, and their running sums.
struct Path {
    /// Times, s, and angles, deg.
    turns: Vec<(f64, f64)>,
    /// Sum of the angles of all pictures before each picture.
    sums: Vec<f64>,
}

impl Path {
    fn new(path: &[PathPoint]) -> Self {
        let turn_of = |point: &PathPoint| (point.seconds, point.place.heading.to_degrees());
        let turns: Vec<_> = path.iter().map(turn_of).collect();
        let mut sums = vec![0.0];
        for (i, (_, angle)) in turns.iter().enumerate() {
            sums.push(sums[i] + angle);
        }
        Self { turns, sums }
    }

    /// Pictures per second, from the median interval, so that missing pictures do not count.
    fn rate(&self) -> f64 {
        let gaps = self.turns.windows(2).map(|pair| pair[1].0 - pair[0].0);
        let mut gaps: Vec<f64> = gaps.collect();
        gaps.sort_by(f64::total_cmp);
        gaps.get(gaps.len() / 2).map_or(0.0, |gap| 1.0 / gap)
    }

    /// The indices of the pictures in a time interval.
    fn indices_between(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let index_at = |time: f64| self.turns.partition_point(|(seconds, _)| *seconds < time);
        index_at(from)..index_at(to)
    }

    /// The indices of the pictures in which the horn rests after an order.
    fn rest_indices(&self, begin: f64, pause: f64, order: usize) -> std::ops::Range<usize> {
        let [from, to] = REST_SHARES.map(|share| begin + pause * (order as f64 + share));
        self.indices_between(from, to)
    }

    /// The mean angle at which the horn rests after an order, deg; `None` if no picture shows it.
    fn rest_angle(&self, begin: f64, pause: f64, order: usize) -> Option<f64> {
        let indices = self.rest_indices(begin, pause, order);
        let sum = self.sums[indices.end] - self.sums[indices.start];
        (!indices.is_empty()).then(|| sum / indices.len() as f64)
    }

    /// The share of the rests' variance that the orders do not explain, if the first order is at `begin`; `None` if
    /// too few rests are visible.
    fn unexplained_share(&self, orders: &[Order], begin: f64, pause: f64) -> Option<f64> {
        let pair_of = |i: usize| Some((orders[i].pulse_angle(), self.rest_angle(begin, pause, i)?));
        let pairs: Vec<(f64, f64)> = (0..orders.len()).filter_map(pair_of).collect();
        if (pairs.len() as f64) < MIN_SEEN_SHARE * orders.len() as f64 {
            return None;
        }
        let mean_of = |component: fn(&(f64, f64)) -> f64| {
            pairs.iter().map(component).sum::<f64>() / pairs.len() as f64
        };
        let (x, y) = (mean_of(|pair| pair.0), mean_of(|pair| pair.1));
        let mut sums = [0.0; 3];
        for (a, b) in &pairs {
            let (a, b) = (a - x, b - y);
            sums = [sums[0] + a * a, sums[1] + a * b, sums[2] + b * b];
        }
        Some(1.0 - sums[1] * sums[1] / (sums[0] * sums[2]).max(1e-9))
    }

    /// Finds the time of the first order for which the unexplained share is smallest; returns both.
    fn find_best(&self, orders: &[Order], pause: f64) -> Option<(f64, f64)> {
        let (first, last) = (self.turns.first()?.0, self.turns.last()?.0);
        let end = last - pause * (orders.len() as f64 - 1.0 + REST_SHARES[0]);
        let try_count = ((end - first + pause) / (SEARCH_STEP * pause)).max(0.0) as usize;
        (0..=try_count)
            .map(|i| first - pause + i as f64 * SEARCH_STEP * pause)
            .filter_map(|begin| Some((self.unexplained_share(orders, begin, pause)?, begin)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(share, begin)| (begin, share))
    }

    /// Finds the time of the first order, s.
    fn find_begin(&self, orders: &[Order]) -> Result<f64, TurnsTrouble> {
        let angles = || self.turns.iter().map(|(_, angle)| *angle);
        let turn = angles().fold(f64::MIN, f64::max) - angles().fold(f64::MAX, f64::min);
        if turn <= MIN_TURN {
            return Err(TurnsTrouble::NotTurned {
                turn: turn.max(0.0),
            });
        }
        let is_explained = |best: &(f64, f64)| best.1 < MAX_UNEXPLAINED;
        if let Some((begin, _)) = self.find_best(orders, PAUSE).filter(is_explained) {
            return Ok(self.refine_begin(begin));
        }
        for multiple in MULTIPLES {
            if self
                .find_best(orders, multiple * PAUSE)
                .is_some_and(|best| is_explained(&best))
            {
                return Err(TurnsTrouble::AnotherPace { times: multiple });
            }
        }
        let seconds = self.turns[self.turns.len() - 1].0 - self.turns[0].0;
        let needed = PAUSE * orders.len() as f64;
        Err(match seconds < needed - PAUSE {
            true => TurnsTrouble::TooShort { seconds, needed },
            false => TurnsTrouble::NotTheSteps,
        })
    }

    /// Refines the time of the first order, s, by the times at which the large steps are half complete.
    fn refine_begin(&self, begin: f64) -> f64 {
        let begin_by_step = |i: usize| {
            let (from, to) = (
                self.rest_angle(begin, PAUSE, i - 1)?,
                self.rest_angle(begin, PAUSE, i)?,
            );
            let middle = (from + to) / 2.0;
            let indices = self.rest_indices(begin, PAUSE, i - 1).start
                ..self.rest_indices(begin, PAUSE, i).end;
            let pairs = self.turns[indices].windows(2);
            let mut crossings = pairs.filter(|pair| (pair[0].1 < middle) != (pair[1].1 < middle));
            let pair = crossings.next()?;
            let share = (middle - pair[0].1) / (pair[1].1 - pair[0].1);
            let time = pair[0].0 + share * (pair[1].0 - pair[0].0);
            Some(time - PAUSE * i as f64 - HALF_WAY_SECONDS)
        };
        let mut begins: Vec<f64> = orders::large_step_indices()
            .filter_map(begin_by_step)
            .collect();
        begins.sort_by(f64::total_cmp);
        begins.get(begins.len() / 2).copied().unwrap_or(begin)
    }

    /// The large steps, counter-clockwise and clockwise.
    fn large_steps(&self, begin: f64, rests: &[Option<f64>]) -> [Vec<Step>; 2] {
        let mut steps = [Vec::new(), Vec::new()];
        for i in orders::large_step_indices() {
            let (Some(from), Some(to)) = (rests[i - 1], rests[i]) else {
                continue;
            };
            let indices =
                self.rest_indices(begin, PAUSE, i - 1).end..self.rest_indices(begin, PAUSE, i).end;
            let turns = self.turns[indices]
                .iter()
                .map(|(time, angle)| (*time, angle - from));
            steps[usize::from(to < from)].push(Step::new(turns, to - from));
        }
        steps
    }

    /// Finds the dead band by the small steps: the servo turns less than ordered by the width of the dead band.
    fn dead_band(
        &self,
        begin: f64,
        orders: &[Order],
        rests: &[Option<f64>],
        gain: f64,
    ) -> DeadBand {
        // Deviations of single pictures from the mean of their rest.
        let (mut squares, mut freedom, mut pictures) = (0.0, 0usize, 0usize);
        for (i, rest) in rests.iter().enumerate() {
            let turns = &self.turns[self.rest_indices(begin, PAUSE, i)];
            let Some(rest) = rest else { continue };
            squares += turns
                .iter()
                .map(|(_, angle)| (angle - rest).powi(2))
                .sum::<f64>();
            freedom += turns.len().saturating_sub(1);
            pictures += turns.len();
        }
        let pictures_per_rest = pictures as f64 / rests.len() as f64;
        let variance = squares / freedom.max(1) as f64;
        let error = (2.0 * variance / pictures_per_rest.max(1.0)).sqrt() / gain.abs();
        let min_movement = MIN_MOVEMENT.max(MOVED_SIGMAS * error);
        let (mut losses, mut largest_still, mut has_moved) = (Vec::new(), 0.0f64, false);
        for i in orders::swings() {
            let (Some(from), Some(to)) = (rests[i - 1], rests[i]) else {
                continue;
            };
            let ordered = orders[i].pulse_angle() - orders[i - 1].pulse_angle();
            let movement = (to - from) / gain * ordered.signum();
            let had_moved = std::mem::replace(&mut has_moved, movement > min_movement);
            if !has_moved {
                largest_still = largest_still.max(ordered.abs());
            } else if had_moved && movement < MAX_SMALL_MOVEMENT {
                // After a movement the servo stands at the edge of its dead band; before one, it may be anywhere
                // within it.
                losses.push(ordered.abs() - movement);
            }
        }
        let width = (losses.len() > 1).then(|| {
            let mean = mean::mean_of_walks(&[(losses, 0.0)]);
            Figure {
                value: mean.mean,
                error: mean.error.hypot(DEAD_BAND_ERROR),
            }
        });
        DeadBand {
            width,
            largest_ignored_step: largest_still,
        }
    }
}
