//! The least squares: measured ways less those of the model, each in its standard errors.
//!
//! A way takes the model tens of milliseconds, so each is computed once, and so are the slopes by the keys, until the
//! keys are far from where they were computed. What is known beforehand counts like a measurement: each key is
//! near the file's value, by its doubt, and the card near its place. So keys that the ways do not tell stay where they
//! are and make the errors of the others as large as they are.

use std::cell::RefCell;

use lizard_robot::Travel;
use nalgebra::{DMatrix, DVector};

use crate::card::{self, Card};
use crate::key::{COUNT, KEYS, PLAY};
use crate::way::Way;

/// Values of the keys.
pub(crate) type Values = [f64; COUNT];
/// Number of unknowns: the keys, then the card's parts.
pub(crate) const UNKNOWNS: usize = COUNT + card::COUNT;
/// Standard deviation of the model's own ways around smooth ones, mm and deg: servos have a dead band and pads stick, so
/// a key that moves a little may shift a step by a frame.
pub(crate) const MODEL_ERROR: f64 = 0.05;
/// Gain of a step in the sum of squares below which a fit has ended; a parameter is then within a third of its error.
const ENOUGH: f64 = 0.1;
/// Gain that a step promised and did not have, up to which it counts as rough ground and not as wrong slopes.
const ROUGH: f64 = 2.0;
/// Largest number of steps of a fit, and of halvings of a step that gains nothing.
const STEPS: usize = 12;
const HALVINGS: usize = 2;
/// Steps of a key from where its slopes were computed, after which they are computed anew: on the way, and where a fit ends.
const FAR: f64 = 4.0;
const NEAR: f64 = 1.0;

/// The ways of a robot, and a model of it.
pub(crate) struct Problem<'a> {
    /// Parts that the model does not decide have an infinite error.
    ways: &'a [Way],
    /// The file's values.
    pub start: Values,
    /// Standard deviations of the unknowns before anything is measured.
    pub doubts: [f64; UNKNOWNS],
    predict: &'a dyn Fn(&Values) -> Vec<Travel>,
    computed: RefCell<Vec<(Values, Vec<Travel>)>>,
    /// Where the slopes are computed.
    slopes_at: RefCell<Option<Values>>,
}

/// All unknowns after a fit, those that were held at their start.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    pub at: [f64; UNKNOWNS],
    /// Covariance of those that were not held, in their order.
    pub covariance: DMatrix<f64>,
    /// Sum of squares of the ways alone.
    pub chi_square: f64,
}

impl<'a> Problem<'a> {
    pub fn new(
        ways: &'a [Way],
        start: Values,
        predict: &'a dyn Fn(&Values) -> Vec<Travel>,
    ) -> Self {
        let keys = KEYS.iter().map(|key| key.doubt());
        let mut doubts = keys.chain(Card::DOUBTS);
        Self {
            ways,
            start,
            doubts: std::array::from_fn(|_| doubts.next().unwrap_or_default()),
            predict,
            computed: RefCell::default(),
            slopes_at: RefCell::default(),
        }
    }

    /// Number of measured figures that count.
    pub fn figures(&self) -> usize {
        let errors = self.ways.iter().flat_map(|way| way.error);
        errors.filter(|error| error.is_finite()).count()
    }

    /// The unknowns before anything is measured.
    pub fn before(&self) -> [f64; UNKNOWNS] {
        std::array::from_fn(|i| self.start.get(i).copied().unwrap_or_default())
    }

    /// The ways of the model, seen by the card.
    pub fn seen(&self, at: &[f64; UNKNOWNS]) -> Vec<[f64; 3]> {
        let (values, card) = split(at);
        let travels = self.travels(&values);
        let seen = travels.into_iter().map(|travel| card.seen(travel));
        seen.map(|seen| [seen.forward, seen.left, seen.turn])
            .collect()
    }

    /// The differences of the measured ways from the model's, in standard errors.
    pub fn differences(&self, at: &[f64; UNKNOWNS]) -> Vec<[f64; 3]> {
        self.scaled(&self.seen(at), |part, mean| mean - part)
    }

    /// The sum of squares that a fit of all unknowns makes small: of the ways' differences, and of what is known beforehand.
    pub fn cost(&self, at: &[f64; UNKNOWNS]) -> f64 {
        let ways = self.differences(at).into_flattened();
        let before = self.before();
        let known = (0..UNKNOWNS).map(|i| (at[i] - before[i]) / self.doubts[i]);
        ways.into_iter().chain(known).map(|part| part * part).sum()
    }

    fn scaled(&self, parts: &[[f64; 3]], of: impl Fn(f64, f64) -> f64) -> Vec<[f64; 3]> {
        let each = self.ways.iter().zip(parts);
        let scaled = |(way, parts): (&Way, &[f64; 3])| {
            std::array::from_fn(|i| of(parts[i], way.mean[i]) / way.error[i].hypot(MODEL_ERROR))
        };
        each.map(scaled).collect()
    }

    /// The travels of the model, continued in a straight line below the least values, so that a key that is
    /// right at its least value may err to both sides.
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

    /// Fits those of the unknowns that are free, the others held at the start, from a guess.
    ///
    /// Gauss and Newton's steps, halved while they gain nothing. A finer search than that is in vain: the model is rough,
    /// because servos have a dead band and pads stick.
    pub fn fit(&self, free: &[usize], guess: &[f64; UNKNOWNS]) -> Option<Solution> {
        let before = self.before();
        let mut at = before;
        for &unknown in free {
            at[unknown] = guess[unknown];
        }
        let residuals = |at: &[f64; UNKNOWNS]| {
            let ways = self.differences(at).into_flattened().into_iter();
            let known = free.iter().map(|&i| (at[i] - before[i]) / self.doubts[i]);
            DVector::from_iterator(3 * self.ways.len() + free.len(), ways.chain(known))
        };
        let mut here = residuals(&at);
        let mut covariance = DMatrix::zeros(0, 0);
        for _ in 0..STEPS {
            let slopes = self.slopes(free, &at);
            let gradient = slopes.tr_mul(&here);
            covariance = slopes.tr_mul(&slopes).cholesky()?.inverse();
            let step = &covariance * &gradient;
            let promised = step.dot(&gradient);
            if promised < ENOUGH {
                // The errors are those of the slopes here, which a fold makes others than where the fit began.
                match self.forget_slopes(split(&at).0, NEAR) {
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
                // Slopes from elsewhere may point the wrong way.
                None if promised > ROUGH && self.forget_slopes(split(&at).0, 0.0) => {}
                None if self.forget_slopes(split(&at).0, NEAR) => {}
                None => break,
            }
        }
        let differences = self.differences(&at).into_flattened();
        let chi_square: f64 = differences.iter().map(|part| part * part).sum();
        let is_known = chi_square.is_finite() && covariance.iter().all(|part| part.is_finite());
        is_known.then_some(Solution {
            at,
            covariance,
            chi_square,
        })
    }

    /// Has slopes computed anew unless they were within so many steps of these values; returns true if so.
    fn forget_slopes(&self, values: Values, steps: f64) -> bool {
        let mut slopes_at = self.slopes_at.borrow_mut();
        let is_elsewhere = !slopes_at.is_some_and(|at| is_within(steps, at, above_least(values)));
        if is_elsewhere {
            *slopes_at = None;
        }
        is_elsewhere
    }

    /// The derivatives of the residuals by the free unknowns.
    fn slopes(&self, free: &[usize], at: &[f64; UNKNOWNS]) -> DMatrix<f64> {
        let near = self.slopes_near(split(at).0);
        let base = std::array::from_fn(|i| near.get(i).copied().unwrap_or(at[i]));
        let here = self.seen(&base);
        let mut slopes = DMatrix::zeros(3 * self.ways.len() + free.len(), free.len());
        for (column, &unknown) in free.iter().enumerate() {
            let step = KEYS.get(unknown).map_or(0.1, |key| key.step);
            let mut moved = base;
            moved[unknown] += step;
            let mut there = self.seen(&moved);
            for (there, here) in there.iter_mut().zip(&here) {
                *there = std::array::from_fn(|i| (here[i] - there[i]) / step);
            }
            let scaled = self.scaled(&there, |slope, _| slope).into_flattened();
            for (row, slope) in scaled.iter().enumerate() {
                slopes[(row, column)] = *slope;
            }
            slopes[(scaled.len() + column, column)] = 1.0 / self.doubts[unknown];
        }
        slopes
    }

    /// Where slopes are computed that hold at these values.
    fn slopes_near(&self, values: Values) -> Values {
        let mut slopes_at = self.slopes_at.borrow_mut();
        if let Some(at) = slopes_at.filter(|at| is_within(FAR, *at, values)) {
            return at;
        }
        // Slopes at the least value are those to its free side.
        let values = above_least(values);
        *slopes_at = Some(values);
        values
    }
}

/// True if each key differs by at most so many of its steps.
fn is_within(steps: f64, a: Values, b: Values) -> bool {
    let mut each = a.iter().zip(b).zip(&KEYS);
    each.all(|((a, b), key)| (a - b).abs() <= steps * key.step)
}

/// The values, or the least possible ones.
fn above_least(values: Values) -> Values {
    std::array::from_fn(|i| values[i].max(KEYS[i].least))
}

/// The values of the keys, and the card.
pub(crate) fn split(at: &[f64; UNKNOWNS]) -> (Values, Card) {
    let card: [f64; card::COUNT] = std::array::from_fn(|i| at[COUNT + i]);
    (std::array::from_fn(|i| at[i]), card.into())
}
