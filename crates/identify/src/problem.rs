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
        let mut doubts = keys.chain(Card::PRIOR_ERRORS);
        Self {
            ways,
            start,
            prior_errors: std::array::from_fn(|_| doubts.next().unwrap_or_default()),
            predict,
            computed: RefCell::default(),
            slopes_at: RefCell::default(),
        }
    }

    /// Number of measured figures with a finite error.
    pub fn figures(&self) -> usize {
        let errors = self.ways.iter().flat_map(|way| way.error);
        errors.filter(|error| error.is_finite()).count()
    }

    /// Start values of the unknowns: the file's keys, and a card exactly in its nominal place.
    pub fn start_unknowns(&self) -> [f64; UNKNOWNS] {
        std::array::from_fn(|i| self.start.get(i).copied().unwrap_or_default())
    }

    /// The movements of the model, as seen on the card.
    pub fn predicted_on_card(&self, at: &[f64; UNKNOWNS]) -> Vec<[f64; 3]> {
        let (values, card) = split(at);
        let travels = self.travels(&values);
        let seen = travels.into_iter().map(|travel| card.card_travel(travel));
        seen.map(|seen| [seen.forward, seen.left, seen.turn])
            .collect()
    }

    /// Differences of the measured movements from those of the model, in standard errors.
    pub fn differences(&self, at: &[f64; UNKNOWNS]) -> Vec<[f64; 3]> {
        self.divide_by_errors(&self.predicted_on_card(at), |part, mean| mean - part)
    }

    /// Sum of squares that a fit of all unknowns minimises: differences of movements, and deviations from the prior
    /// values.
    pub fn cost(&self, at: &[f64; UNKNOWNS]) -> f64 {
        let ways = self.differences(at).into_flattened();
        let before = self.start_unknowns();
        let known = (0..UNKNOWNS).map(|i| (at[i] - before[i]) / self.prior_errors[i]);
        ways.into_iter().chain(known).map(|part| part * part).sum()
    }

    /// Combines each predicted part with the measured one by `of`, and divides the result by its standard error, which
    /// includes the model's roughness.
    fn divide_by_errors(&self, parts: &[[f64; 3]], of: impl Fn(f64, f64) -> f64) -> Vec<[f64; 3]> {
        let each = self.ways.iter().zip(parts);
        let scaled = |(way, parts): (&MeasuredMovement, &[f64; 3])| {
            std::array::from_fn(|i| of(parts[i], way.mean[i]) / way.error[i].hypot(MODEL_ERROR))
        };
        each.map(scaled).collect()
    }

    /// The movements that the model predicts. Those for a negative play are extrapolated as 2 f(0) - f(-play), so
    /// that the fit of a robot without play may err in both directions. Other keys are limited to their least values.
    fn travels(&self, values: &Values) -> Vec<Travel> {
        if values[PLAY] < 0.0 {
            let with = |play: f64| {
                let mut values = *values;
                values[PLAY] = play;
                self.travels(&values)
            };
            let mirrored = with(0.0).into_iter().zip(with(-values[PLAY]));
            let continued = |at: f64, beyond: f64| 2.0 * at - beyond;
            return mirrored
                .map(|(at, beyond)| Travel {
                    forward: continued(at.forward, beyond.forward),
                    left: continued(at.left, beyond.left),
                    turn: continued(at.turn, beyond.turn),
                })
                .collect();
        }
        let values = above_least(*values);
        let known = |(at, _): &&(Values, Vec<Travel>)| *at == values;
        if let Some((_, travels)) = self.computed.borrow().iter().find(known) {
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
        let before = self.start_unknowns();
        let mut at = before;
        for &unknown in free {
            at[unknown] = guess[unknown];
        }
        let residuals = |at: &[f64; UNKNOWNS]| {
            let ways = self.differences(at).into_flattened().into_iter();
            let known = free
                .iter()
                .map(|&i| (at[i] - before[i]) / self.prior_errors[i]);
            DVector::from_iterator(3 * self.ways.len() + free.len(), ways.chain(known))
        };
        let mut here = residuals(&at);
        let mut covariance = DMatrix::zeros(0, 0);
        for _ in 0..MAX_STEPS {
            let slopes = self.slopes(free, &at);
            let gradient = slopes.tr_mul(&here);
            covariance = slopes.tr_mul(&slopes).cholesky()?.inverse();
            let step = &covariance * &gradient;
            let promised = step.dot(&gradient);
            if promised < MIN_PROMISED_GAIN {
                // The errors come from the derivatives, which beyond a fold differ from those at the start of the
                // fit.
                match self.forget_slopes(split(&at).0, NEAR_STEPS) {
                    true => continue,
                    false => break,
                }
            }
            let shorter = (0..=HALVINGS).map(|halvings| {
                let mut next = at;
                for (unknown, step) in free.iter().zip(step.iter()) {
                    next[*unknown] -= step / f64::from(1 << halvings);
                }
                (next, residuals(&next))
            });
            let mut better =
                shorter.filter(|(_, there)| there.norm_squared() < here.norm_squared());
            match better.next() {
                Some(next) => (at, here) = next,
                // Derivatives from another point may give a wrong direction.
                None if promised > ROUGHNESS_GAIN && self.forget_slopes(split(&at).0, 0.0) => {}
                None if self.forget_slopes(split(&at).0, NEAR_STEPS) => {}
                None => break,
            }
        }
        let differences = self.differences(&at).into_flattened();
        let chi_square: f64 = differences.iter().map(|part| part * part).sum();
        let is_known = chi_square.is_finite() && covariance.iter().all(|part| part.is_finite());
        is_known.then_some(Solution {
            unknowns: at,
            covariance,
            chi_square,
        })
    }

    /// Discards the derivatives if they were computed more than `steps` steps of a key from these values. Returns
    /// true if none are left.
    fn forget_slopes(&self, values: Values, steps: f64) -> bool {
        let mut slopes_at = self.slopes_at.borrow_mut();
        let is_elsewhere = !slopes_at.is_some_and(|at| is_within(steps, at, above_least(values)));
        if is_elsewhere {
            *slopes_at = None;
        }
        is_elsewhere
    }

    /// Derivatives of the residuals with respect to the free unknowns.
    fn slopes(&self, free: &[usize], at: &[f64; UNKNOWNS]) -> DMatrix<f64> {
        let near = self.slopes_near(split(at).0);
        let base = std::array::from_fn(|i| near.get(i).copied().unwrap_or(at[i]));
        let here = self.predicted_on_card(&base);
        let mut slopes = DMatrix::zeros(3 * self.ways.len() + free.len(), free.len());
        for (column, &unknown) in free.iter().enumerate() {
            let step = KEYS.get(unknown).map_or(0.1, |key| key.step);
            let mut moved = base;
            moved[unknown] += step;
            let mut there = self.predicted_on_card(&moved);
            for (there, here) in there.iter_mut().zip(&here) {
                *there = std::array::from_fn(|i| (here[i] - there[i]) / step);
            }
            let scaled = self
                .divide_by_errors(&there, |slope, _| slope)
                .into_flattened();
            for (row, slope) in scaled.iter().enumerate() {
                slopes[(row, column)] = *slope;
            }
            slopes[(scaled.len() + column, column)] = 1.0 / self.prior_errors[unknown];
        }
        slopes
    }

    /// The point at which to compute derivatives that are valid at these values: the previous point if it is near
    /// enough.
    fn slopes_near(&self, values: Values) -> Values {
        let mut slopes_at = self.slopes_at.borrow_mut();
        if let Some(at) = slopes_at.filter(|at| is_within(FAR_STEPS, *at, values)) {
            return at;
        }
        // At a key's least value, the derivatives are those of its feasible side.
        let values = above_least(values);
        *slopes_at = Some(values);
        values
    }
}

/// True if each key differs by at most `steps` of its steps.
fn is_within(steps: f64, a: Values, b: Values) -> bool {
    let mut each = a.iter().zip(b).zip(&KEYS);
    each.all(|((a, b), key)| (a - b).abs() <= steps * key.step)
}

/// The values, each raised to the least possible value of its key if it is below it.
fn above_least(values: Values) -> Values {
    std::array::from_fn(|i| values[i].max(KEYS[i].least))
}

/// Splits the unknowns into the values of the keys and the card.
pub(crate) fn split(at: &[f64; UNKNOWNS]) -> (Values, Card) {
    let card: [f64; card::COUNT] = std::array::from_fn(|i| at[KEY_COUNT + i]);
    (std::array::from_fn(|i| at[i]), card.into())
}
