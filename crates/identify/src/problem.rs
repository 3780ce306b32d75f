//! The least-squares problem: residuals of the measured movements against the model, in units of their standard errors.
//!
//! For each set of values, the model simulates every gait again. Therefore each result is cached, and derivatives with
//! respect to the keys are reused for nearby values. Prior knowledge counts as a measurement: each key has the file's
//! value, with the prior standard deviation as its error, and the tag card is near its nominal place on the deck. A key
//! that the movements do not determine keeps the file's value, and its uncertainty enlarges the errors of the other
//! keys.

use std::cell::RefCell;

use lizard_robot::Travel;
use nalgebra::{DMatrix, DVector};

use crate::card::{self, CardPose};
use crate::key::{KEY_COUNT, KEYS, PLAY_INDEX};
use crate::movement::MeasuredMovement;

/// Values of the keys, in the order of [`KEYS`].
pub(crate) type Values = [f64; KEY_COUNT];
/// Number of unknowns: the keys, then the card's parameters.
pub(crate) const UNKNOWN_COUNT: usize = KEY_COUNT + card::PARAMETER_COUNT;
/// Values of the unknowns.
pub(crate) type Unknowns = [f64; UNKNOWN_COUNT];
/// Standard deviation of the error that the model's roughness causes, mm and deg: servos have a dead band and pads
/// stick, so a small change of a key may shift an event of the gait by a frame.
pub(crate) const MODEL_ERROR: f64 = 0.05;
/// Smallest predicted reduction of the sum of squares for another step of a fit. At the end of a fit, no unknown is
/// farther from the minimum than a third of its standard error.
const MIN_PREDICTED_REDUCTION: f64 = 0.1;
/// Largest predicted reduction for which an unsuccessful step is attributed to the model's roughness and not to wrong
/// derivatives.
const MAX_REDUCTION_FROM_ROUGHNESS: f64 = 2.0;
/// Largest number of iterations of a fit.
const MAX_ITERATIONS: usize = 12;
/// Largest number of halvings of a step that does not reduce the sum of squares.
const MAX_HALVINGS: usize = 2;
/// Largest distance at which derivatives are reused during a fit, in derivative steps of each key.
const MAX_REUSE_DISTANCE_DURING_FIT: f64 = 4.0;
/// Largest distance at which derivatives are reused at the end of a fit, in derivative steps of each key.
const MAX_REUSE_DISTANCE_AT_END: f64 = 1.0;

/// The measured movements of a robot, and a model of it.
pub(crate) struct Problem<'a> {
    /// The measured movements. Components that the model cannot predict have an infinite error.
    movements: &'a [MeasuredMovement],
    /// Start values of the unknowns: the file's values of the keys, and a card exactly in its nominal position.
    pub start: Unknowns,
    /// Prior standard deviations of the unknowns.
    pub prior_errors: Unknowns,
    /// The model: predicts the movements for values of the keys.
    predict: &'a dyn Fn(&Values) -> Vec<Travel>,
    /// The model's results for all values so far.
    cached_results: RefCell<Vec<(Values, Vec<Travel>)>>,
    /// Values of the keys at which the derivatives are computed; `None` if the next step of a fit must choose new
    /// values.
    jacobian_point: RefCell<Option<Values>>,
}

/// The result of a fit.
#[derive(Clone, Debug)]
pub(crate) struct Fit {
    /// Values of all unknowns; the unknowns that were not free have their start values.
    pub unknowns: Unknowns,
    /// Covariance of the free unknowns, in their order.
    pub covariance: DMatrix<f64>,
    /// Sum of the squared residuals of the movements, without the prior.
    pub chi_square: f64,
}

impl<'a> Problem<'a> {
    pub fn new(
        movements: &'a [MeasuredMovement],
        file_values: Values,
        predict: &'a dyn Fn(&Values) -> Vec<Travel>,
    ) -> Self {
        let key_errors = KEYS.iter().map(|key| key.prior_error());
        let mut prior_errors = key_errors.chain(CardPose::PRIOR_ERRORS);
        Self {
            movements,
            start: std::array::from_fn(|i| file_values.get(i).copied().unwrap_or_default()),
            prior_errors: std::array::from_fn(|_| prior_errors.next().unwrap_or_default()),
            predict,
            cached_results: RefCell::default(),
            jacobian_point: RefCell::default(),
        }
    }

    /// Number of measured values with a finite error.
    pub fn measured_value_count(&self) -> usize {
        let errors = self.movements.iter().flat_map(|movement| movement.error);
        errors.filter(|error| error.is_finite()).count()
    }

    /// Predicts the card's movements with the model.
    pub fn predict_card_movements(&self, unknowns: &Unknowns) -> Vec<[f64; 3]> {
        let (values, card) = split_unknowns(unknowns);
        let travels = self.predict_robot_travels(&values).into_iter();
        travels.map(|travel| card.convert_travel(travel)).collect()
    }

    /// Computes the residuals of the movements' components, measured minus predicted, in standard errors.
    pub fn compute_residuals(&self, unknowns: &Unknowns) -> Vec<f64> {
        let predicted = self.predict_card_movements(unknowns).into_flattened();
        let means = self.movements.iter().flat_map(|movement| movement.mean);
        let pairs = means.zip(predicted);
        self.divide_by_errors(pairs.map(|(mean, predicted)| mean - predicted))
    }

    /// Computes the residuals of the movements, followed by the deviations of some unknowns from their prior values.
    fn compute_all_residuals(&self, included_unknowns: &[usize], unknowns: &Unknowns) -> Vec<f64> {
        let prior_deviation = |&i: &usize| (unknowns[i] - self.start[i]) / self.prior_errors[i];
        let mut residuals = self.compute_residuals(unknowns);
        residuals.extend(included_unknowns.iter().map(prior_deviation));
        residuals
    }

    /// Computes the sum of squares that a fit of all unknowns minimises: residuals of the movements, and deviations
    /// from the prior values.
    pub fn compute_sum_of_squares(&self, unknowns: &Unknowns) -> f64 {
        let all_unknowns: [usize; UNKNOWN_COUNT] = std::array::from_fn(|i| i);
        let residuals = self.compute_all_residuals(&all_unknowns, unknowns);
        residuals.iter().map(|residual| residual * residual).sum()
    }

    /// Divides each value by the standard error of its component of the movements; the error includes the model's
    /// roughness.
    fn divide_by_errors(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let errors = self.movements.iter().flat_map(|movement| movement.error);
        let pairs = values.zip(errors);
        let scaled_values = pairs.map(|(value, error)| value / error.hypot(MODEL_ERROR));
        scaled_values.collect()
    }

    /// Predicts the robot's movements with the model, and caches them. No robot has negative play, but a fit may use
    /// it: otherwise random errors could only increase the play of a robot without play. Movements for negative play
    /// are extrapolated as `2 f(0) - f(-play)`. Other values that are too small are raised to the smallest possible.
    fn predict_robot_travels(&self, values: &Values) -> Vec<Travel> {
        if values[PLAY_INDEX] < 0.0 {
            let predict_with_play = |play: f64| {
                let mut values = *values;
                values[PLAY_INDEX] = play;
                self.predict_robot_travels(&values)
            };
            let travels_at_zero = predict_with_play(0.0).into_iter();
            let travel_pairs = travels_at_zero.zip(predict_with_play(-values[PLAY_INDEX]));
            let extrapolated_travels = travel_pairs.map(|(at_zero, mirrored)| Travel {
                forward: 2.0 * at_zero.forward - mirrored.forward,
                left: 2.0 * at_zero.left - mirrored.left,
                turn: 2.0 * at_zero.turn - mirrored.turn,
            });
            return extrapolated_travels.collect();
        }
        let values = raise_to_min_values(*values);
        let has_these_values =
            |(cached_values, _): &&(Values, Vec<Travel>)| *cached_values == values;
        if let Some((_, travels)) = self.cached_results.borrow().iter().find(has_these_values) {
            return travels.clone();
        }
        let travels = (self.predict)(&values);
        let result = (values, travels.clone());
        self.cached_results.borrow_mut().push(result);
        travels
    }

    /// Fits the free unknowns, starting from a guess; the other unknowns keep their start values.
    ///
    /// Uses the Gauss-Newton method, and halves a step that does not reduce the sum of squares. A finer search would be
    /// useless, since the model is rough: servos have a dead band and pads stick.
    pub fn fit(&self, free_unknowns: &[usize], guess: &Unknowns) -> Option<Fit> {
        let mut unknowns = self.start;
        for &unknown in free_unknowns {
            unknowns[unknown] = guess[unknown];
        }
        let compute_all_residuals = |unknowns: &Unknowns| {
            DVector::from_vec(self.compute_all_residuals(free_unknowns, unknowns))
        };
        let mut current_residuals = compute_all_residuals(&unknowns);
        let mut covariance = DMatrix::zeros(0, 0);
        for _ in 0..MAX_ITERATIONS {
            let jacobian = self.compute_jacobian(free_unknowns, &unknowns);
            let gradient = jacobian.tr_mul(&current_residuals);
            covariance = jacobian.tr_mul(&jacobian).cholesky()?.inverse();
            let step = &covariance * &gradient;
            let predicted_reduction = step.dot(&gradient);
            if predicted_reduction < MIN_PREDICTED_REDUCTION {
                // The standard errors follow from the derivatives, which must therefore be computed near the end.
                match self.discard_distant_point(&unknowns, MAX_REUSE_DISTANCE_AT_END) {
                    true => continue,
                    false => break,
                }
            }
            let candidates = (0..=MAX_HALVINGS).map(|halvings| {
                let mut candidate = unknowns;
                for (unknown, step) in free_unknowns.iter().zip(step.iter()) {
                    candidate[*unknown] -= step / f64::from(1 << halvings);
                }
                let residuals = compute_all_residuals(&candidate);
                (candidate, residuals)
            });
            let mut better_candidates = candidates.filter(|(_, residuals)| {
                residuals.norm_squared() < current_residuals.norm_squared()
            });
            match better_candidates.next() {
                Some(candidate) => (unknowns, current_residuals) = candidate,
                // Derivatives from another point may give a wrong direction.
                None if predicted_reduction > MAX_REDUCTION_FROM_ROUGHNESS
                    && self.discard_distant_point(&unknowns, 0.0) => {}
                None if self.discard_distant_point(&unknowns, MAX_REUSE_DISTANCE_AT_END) => {}
                None => break,
            }
        }
        let residuals = self.compute_residuals(&unknowns);
        let chi_square: f64 = residuals.iter().map(|residual| residual * residual).sum();
        let is_finite = chi_square.is_finite() && covariance.iter().all(|value| value.is_finite());
        is_finite.then_some(Fit {
            unknowns,
            covariance,
            chi_square,
        })
    }

    /// Discards the point of the derivatives if any key is more than `max_steps` derivative steps away from its value
    /// in `unknowns`. Returns true if no point is left.
    fn discard_distant_point(&self, unknowns: &Unknowns, max_steps: f64) -> bool {
        let values = raise_to_min_values(split_unknowns(unknowns).0);
        let mut jacobian_point = self.jacobian_point.borrow_mut();
        let is_distant =
            !jacobian_point.is_some_and(|point| are_within_steps(max_steps, point, values));
        if is_distant {
            *jacobian_point = None;
        }
        is_distant
    }

    /// Computes the derivatives of the residuals with respect to the free unknowns.
    fn compute_jacobian(&self, free_unknowns: &[usize], unknowns: &Unknowns) -> DMatrix<f64> {
        let near_values = self.choose_jacobian_point(split_unknowns(unknowns).0);
        let base = std::array::from_fn(|i| near_values.get(i).copied().unwrap_or(unknowns[i]));
        let base_movements = self.predict_card_movements(&base).into_flattened();
        let row_count = 3 * self.movements.len() + free_unknowns.len();
        let mut jacobian = DMatrix::zeros(row_count, free_unknowns.len());
        for (column, &unknown) in free_unknowns.iter().enumerate() {
            let shift = KEYS.get(unknown).map_or(0.1, |key| key.derivative_step);
            let mut shifted_unknowns = base;
            shifted_unknowns[unknown] += shift;
            let shifted_movements = self.predict_card_movements(&shifted_unknowns);
            let pairs = base_movements.iter().zip(shifted_movements.as_flattened());
            let slopes =
                self.divide_by_errors(pairs.map(|(base, shifted)| (base - shifted) / shift));
            for (row, slope) in slopes.iter().enumerate() {
                jacobian[(row, column)] = *slope;
            }
            jacobian[(slopes.len() + column, column)] = 1.0 / self.prior_errors[unknown];
        }
        jacobian
    }

    /// Returns the previous point of the derivatives if it is near enough to `values`; otherwise chooses `values`.
    fn choose_jacobian_point(&self, values: Values) -> Values {
        let mut jacobian_point = self.jacobian_point.borrow_mut();
        let is_near =
            |point: &Values| are_within_steps(MAX_REUSE_DISTANCE_DURING_FIT, *point, values);
        if let Some(point) = jacobian_point.filter(is_near) {
            return point;
        }
        // At a key's smallest value, the derivative is taken on the feasible side.
        let values = raise_to_min_values(values);
        *jacobian_point = Some(values);
        values
    }
}

/// Returns true if each key differs by at most `max_steps` of its derivative steps.
fn are_within_steps(max_steps: f64, a: Values, b: Values) -> bool {
    let mut pairs = a.iter().zip(b).zip(&KEYS);
    pairs.all(|((a, b), key)| (a - b).abs() <= max_steps * key.derivative_step)
}

/// Raises each value that is too small to its key's smallest possible value.
fn raise_to_min_values(values: Values) -> Values {
    std::array::from_fn(|i| values[i].max(KEYS[i].min_value))
}

/// Splits the unknowns into the values of the keys and the card.
pub(crate) fn split_unknowns(unknowns: &Unknowns) -> (Values, CardPose) {
    let card: [f64; card::PARAMETER_COUNT] = std::array::from_fn(|i| unknowns[KEY_COUNT + i]);
    (std::array::from_fn(|i| unknowns[i]), card.into())
}
