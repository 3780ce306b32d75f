//! The least-squares problem: differences between measured movements and those of the model, in units of their
//! standard errors.
//!
//! The model takes tens of milliseconds for one movement. So each result is stored, and the derivatives with respect
//! to the keys are reused until the keys are far from the point at which they were computed. Prior knowledge counts
//! as a measurement: each key is near the file's value, within its prior standard deviation, and the card is near its
//! nominal place. So a key that the movements do not determine stays where it is, and its uncertainty enlarges the
//! errors of the others.

use std::cell::RefCell;

use lizard_robot::Travel;
use nalgebra::{DMatrix, DVector};

use crate::card::{self, Card};
use crate::key::{KEY_COUNT, KEYS, PLAY};
use crate::way::MeasuredMovement;

/// Values of the keys, in the order of [`KEYS`].
pub(crate) type Values = [f64; KEY_COUNT];
/// Number of unknowns: the keys, then the card's parameters.
pub(crate) const UNKNOWNS: usize = KEY_COUNT + card::COUNT;
/// Standard deviation of the model's roughness around a smooth model, mm and deg: servos have a dead band and pads
/// stick, so a small change of a key may shift a step by a frame.
pub(crate) const MODEL_ERROR: f64 = 0.05;
/// Predicted reduction of the sum of squares by the next step below which a fit ends; a parameter is then within a
/// third of its error.
const MIN_PROMISED_GAIN: f64 = 0.1;
/// Largest predicted reduction for which a step without any gain is attributed to the model's roughness and not to
/// wrong derivatives.
const ROUGHNESS_GAIN: f64 = 2.0;
/// Largest number of steps of a fit.
const MAX_STEPS: usize = 12;
/// Largest number of halvings of a step that does not reduce the sum of squares.
const HALVINGS: usize = 2;
/// Distance from the point of the derivatives, in steps of a key, beyond which they are recomputed during a fit.
const FAR_STEPS: f64 = 4.0;
/// Distance from the point of the derivatives, in steps of a key, beyond which they are recomputed at the end of a
/// fit.
const NEAR_STEPS: f64 = 1.0;

/// The measured movements of a robot, and a model of it.
pub(crate) struct Problem<'a> {
    /// The measured movements. Parts that the model leaves undetermined have an infinite error.
    ways: &'a [MeasuredMovement],
    /// The file's values.
    pub start: Values,
    /// Prior standard deviations of the unknowns.
    pub prior_errors: [f64; UNKNOWNS],
    predict: &'a dyn Fn(&Values) -> Vec<Travel>,
    /// Results of the model for all values so far.
    computed: RefCell<Vec<(Values, Vec<Travel>)>>,
    /// Values at which the derivatives are computed; `None` if they have to be chosen anew.
    slopes_at: RefCell<Option<Values>>,
}

/// The result of a fit.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// Values of all unknowns; those that were held have their start values.
    pub unknowns: [f64; UNKNOWNS],
    /// Covariance of the free unknowns, in their order.
    pub covariance: DMatrix<f64>,
    /// Sum of squares of the measured movements alone, without the prior.
    pub chi_square: f64,
}

impl<'a> Problem<'a> {
    pub fn new(
        ways: &'a [MeasuredMovement],
        start: Values,
        predict: &'a dyn Fn(&Values) -> Vec<Travel>,
    ) -> Self {
        let keys = KEYS.iter().map(|key| key.prior_error());
        let mut prior_errors = keys.chain(Card::PRIOR_ERRORS);
        Self {
            ways,
            start,
            prior_errors: std::array::from_fn(|_| prior_errors.next().unwrap_or_default()),
            predict,
            computed: RefCell::default(),
            slopes_at: RefCell::default(),
        }
    }

    /// Number of measured figures with a finite error.
    pub fn figures(&self) -> usize {
        let errors = self.ways.iter().flat_map(|movement| movement.error);
        errors.filter(|error| error.is_finite()).count()
    }

    /// Start values of the unknowns: the file's keys, and a card exactly in its nominal place.
    pub fn start_unknowns(&self) -> [f64; UNKNOWNS] {
        std::array::from_fn(|i| self.start.get(i).copied().unwrap_or_default())
    }

    /// The movements of the model, as seen on the card.
    pub fn predicted_on_card(&self, unknowns: &[f64; UNKNOWNS]) -> Vec<[f64; 3]> {
        let (values, card) = split(unknowns);
        let travels = self.travels(&values);
        let seen_travels = travels.into_iter().map(|travel| card.card_travel(travel));
        seen_travels
            .map(|travel| [travel.forward, travel.left, travel.turn])
            .collect()
    }

    /// Differences of the measured movements from those of the model, in standard errors.
    pub fn differences(&self, unknowns: &[f64; UNKNOWNS]) -> Vec<[f64; 3]> {
        self.divide_by_errors(&self.predicted_on_card(unknowns), |part, mean| mean - part)
    }

    /// Sum of squares that a fit of all unknowns minimises: differences of movements, and deviations from the prior
    /// values.
    pub fn cost(&self, unknowns: &[f64; UNKNOWNS]) -> f64 {
        let differences = self.differences(unknowns).into_flattened();
        let start = self.start_unknowns();
        let prior_deviations =
            (0..UNKNOWNS).map(|i| (unknowns[i] - start[i]) / self.prior_errors[i]);
        differences
            .into_iter()
            .chain(prior_deviations)
            .map(|difference| difference * difference)
            .sum()
    }

    /// Combines each predicted part with the measured one by `combine`, and divides the result by its standard error,
    /// which includes the model's roughness.
    fn divide_by_errors(
        &self,
        parts: &[[f64; 3]],
        combine: impl Fn(f64, f64) -> f64,
    ) -> Vec<[f64; 3]> {
        let rows = self.ways.iter().zip(parts);
        let divided_row_of = |(movement, parts): (&MeasuredMovement, &[f64; 3])| {
            std::array::from_fn(|i| {
                combine(parts[i], movement.mean[i]) / movement.error[i].hypot(MODEL_ERROR)
            })
        };
        rows.map(divided_row_of).collect()
    }

    /// The movements that the model predicts. Those for a negative play are extrapolated as 2 f(0) - f(-play), so
    /// that the fit of a robot without play may err in both directions. Other keys are limited to their least values.
    fn travels(&self, values: &Values) -> Vec<Travel> {
        if values[PLAY] < 0.0 {
            let travels_with_play = |play: f64| {
                let mut values = *values;
                values[PLAY] = play;
                self.travels(&values)
            };
            let travel_pairs = travels_with_play(0.0)
                .into_iter()
                .zip(travels_with_play(-values[PLAY]));
            let extrapolate = |at_zero: f64, mirrored: f64| 2.0 * at_zero - mirrored;
            return travel_pairs
                .map(|(at_zero, mirrored)| Travel {
                    forward: extrapolate(at_zero.forward, mirrored.forward),
                    left: extrapolate(at_zero.left, mirrored.left),
                    turn: extrapolate(at_zero.turn, mirrored.turn),
                })
                .collect();
        }
        let values = raise_to_least(*values);
        let has_values = |(known_values, _): &&(Values, Vec<Travel>)| *known_values == values;
        if let Some((_, travels)) = self.computed.borrow().iter().find(has_values) {
            return travels.clone();
        }
        let travels = (self.predict)(&values);
        let mut computed = self.computed.borrow_mut();
        computed.push((values, travels.clone()));
        travels
    }

    /// Fits the free unknowns from a guess; the others are held at their start values.
    ///
    /// The method is Gauss-Newton, with steps that are halved while they gain nothing. A finer search is useless,
    /// since the model is rough: servos have a dead band and pads stick.
    pub fn fit(&self, free: &[usize], guess: &[f64; UNKNOWNS]) -> Option<Solution> {
        let start = self.start_unknowns();
        let mut unknowns = start;
        for &unknown in free {
            unknowns[unknown] = guess[unknown];
        }
        let residuals_at = |unknowns: &[f64; UNKNOWNS]| {
            let differences = self.differences(unknowns).into_flattened().into_iter();
            let prior_deviations = free
                .iter()
                .map(|&i| (unknowns[i] - start[i]) / self.prior_errors[i]);
            DVector::from_iterator(
                3 * self.ways.len() + free.len(),
                differences.chain(prior_deviations),
            )
        };
        let mut current_residuals = residuals_at(&unknowns);
        let mut covariance = DMatrix::zeros(0, 0);
        for _ in 0..MAX_STEPS {
            let slopes = self.slopes(free, &unknowns);
            let gradient = slopes.tr_mul(&current_residuals);
            covariance = slopes.tr_mul(&slopes).cholesky()?.inverse();
            let step = &covariance * &gradient;
            let promised_gain = step.dot(&gradient);
            if promised_gain < MIN_PROMISED_GAIN {
                // The errors come from the derivatives, which beyond a fold differ from those at the start of the
                // fit.
                match self.forget_slopes(split(&unknowns).0, NEAR_STEPS) {
                    true => continue,
                    false => break,
                }
            }
            let shortened_steps = (0..=HALVINGS).map(|halvings| {
                let mut next_unknowns = unknowns;
                for (unknown, step) in free.iter().zip(step.iter()) {
                    next_unknowns[*unknown] -= step / f64::from(1 << halvings);
                }
                (next_unknowns, residuals_at(&next_unknowns))
            });
            let mut better_steps = shortened_steps.filter(|(_, residuals)| {
                residuals.norm_squared() < current_residuals.norm_squared()
            });
            match better_steps.next() {
                Some(next_step) => (unknowns, current_residuals) = next_step,
                // Derivatives from another point may give a wrong direction.
                None if promised_gain > ROUGHNESS_GAIN
                    && self.forget_slopes(split(&unknowns).0, 0.0) => {}
                None if self.forget_slopes(split(&unknowns).0, NEAR_STEPS) => {}
                None => break,
            }
        }
        let differences = self.differences(&unknowns).into_flattened();
        let chi_square: f64 = differences.iter().map(|part| part * part).sum();
        let is_known = chi_square.is_finite() && covariance.iter().all(|part| part.is_finite());
        is_known.then_some(Solution {
            unknowns,
            covariance,
            chi_square,
        })
    }

    /// Discards the derivatives if they were computed more than `steps` steps of a key from these values. Returns
    /// true if none are left.
    fn forget_slopes(&self, values: Values, steps: f64) -> bool {
        let mut slopes_at = self.slopes_at.borrow_mut();
        let is_elsewhere =
            !slopes_at.is_some_and(|point| is_within(steps, point, raise_to_least(values)));
        if is_elsewhere {
            *slopes_at = None;
        }
        is_elsewhere
    }

    /// Derivatives of the residuals with respect to the free unknowns.
    fn slopes(&self, free: &[usize], unknowns: &[f64; UNKNOWNS]) -> DMatrix<f64> {
        let near_values = self.slopes_near(split(unknowns).0);
        let base = std::array::from_fn(|i| near_values.get(i).copied().unwrap_or(unknowns[i]));
        let base_movements = self.predicted_on_card(&base);
        let mut slopes = DMatrix::zeros(3 * self.ways.len() + free.len(), free.len());
        for (column, &unknown) in free.iter().enumerate() {
            let step = KEYS.get(unknown).map_or(0.1, |key| key.step);
            let mut moved_unknowns = base;
            moved_unknowns[unknown] += step;
            let mut moved_movements = self.predicted_on_card(&moved_unknowns);
            for (moved_movement, base_movement) in moved_movements.iter_mut().zip(&base_movements) {
                *moved_movement =
                    std::array::from_fn(|i| (base_movement[i] - moved_movement[i]) / step);
            }
            let scaled_slopes = self
                .divide_by_errors(&moved_movements, |slope, _| slope)
                .into_flattened();
            for (row, slope) in scaled_slopes.iter().enumerate() {
                slopes[(row, column)] = *slope;
            }
            slopes[(scaled_slopes.len() + column, column)] = 1.0 / self.prior_errors[unknown];
        }
        slopes
    }

    /// The point at which to compute derivatives that are valid at these values: the previous point if it is near
    /// enough.
    fn slopes_near(&self, values: Values) -> Values {
        let mut slopes_at = self.slopes_at.borrow_mut();
        if let Some(point) = slopes_at.filter(|point| is_within(FAR_STEPS, *point, values)) {
            return point;
        }
        // At a key's least value, the derivatives are those of its feasible side.
        let values = raise_to_least(values);
        *slopes_at = Some(values);
        values
    }
}

/// True if each key differs by at most `steps` of its steps.
fn is_within(steps: f64, a: Values, b: Values) -> bool {
    let mut pairs = a.iter().zip(b).zip(&KEYS);
    pairs.all(|((a, b), key)| (a - b).abs() <= steps * key.step)
}

/// The values, each raised to the least possible value of its key if it is below it.
fn raise_to_least(values: Values) -> Values {
    std::array::from_fn(|i| values[i].max(KEYS[i].least))
}

/// Splits the unknowns into the values of the keys and the card.
pub(crate) fn split(unknowns: &[f64; UNKNOWNS]) -> (Values, Card) {
    let card: [f64; card::COUNT] = std::array::from_fn(|i| unknowns[KEY_COUNT + i]);
    (std::array::from_fn(|i| unknowns[i]), card.into())
}
