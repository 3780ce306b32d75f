//! The fit of all keys, and the choice of the keys to change.
//!
//! First, a fit has all keys free. It provides the reported standard errors, because the file's values enter this fit
//! only through wide priors. Then keys are held at their file values: first all undetermined keys, then one key at a
//! time, always the key whose value is nearest to the file's in standard errors, until every free key is at least two
//! standard errors away. A key whose value is then impossible is held, too. Whenever a key is held, the free keys are
//! adjusted. Therefore, if two keys have the same effect, only one of them changes.

use lizard_robot::{CheckedGait, Robot, Travel};
use nalgebra::DMatrix;

use crate::chi_square::compute_percentile_99;
use crate::error::IdentifyError;
use crate::key::{FRICTION_RATIO_INDEX, KEY_COUNT, KEYS, Key, PLAY_INDEX, TWIST_INDEX};
use crate::movement::MeasuredMovement;
use crate::outcome::{GoodnessOfFit, Identification, KeyResult, MovementResult, Verdict};
use crate::problem::{Fit, Problem, UNKNOWN_COUNT, Unknowns, Values, split_unknowns};

/// Indices in [`KEYS`] of the keys with the strongest nonlinearity near the file's value.
const NONLINEAR_KEYS: [usize; 3] = [PLAY_INDEX, TWIST_INDEX, FRICTION_RATIO_INDEX];
/// Smallest distance from the file's value at which a key changes, standard errors.
const MIN_SIGNIFICANT_DISTANCE: f64 = 2.0;
/// Lower bound for the rise of the sum of squares when a key is shifted by [`MIN_SIGNIFICANT_DISTANCE`]. A smaller rise
/// may be due to the model's roughness. With this bound, a standard error is enlarged at most fourfold.
const MIN_RISE: f64 = 0.25;
/// Largest standard error of a determined key, as a fraction of the prior standard deviation.
const MAX_ERROR_FRACTION: f64 = 0.5;
/// Absolute correlation of errors above which two keys are reported as hard to distinguish.
const MIN_CORRELATION: f64 = 0.8;

/// A function that runs a job for each index below a count, sequentially or on all cores, and returns the results in
/// order.
pub type Executor<'a> = &'a dyn Fn(usize, &(dyn Fn(usize) -> Travel + Sync)) -> Vec<Travel>;

/// Identifies a robot's keys from its measured movements. `run_all` runs the gait simulations: a few hundred of about
/// 0.1 s each.
///
/// # Errors
/// Fails if a gait does not exist or moves no servo, if a measured value is not finite or out of range, or if no
/// movement determines a key.
pub fn identify(
    robot: &Robot,
    movements: &[MeasuredMovement],
    run_all: Executor,
) -> Result<Identification, IdentifyError> {
    let mut movements = movements.to_vec();
    let mut gait_runs = Vec::new();
    for movement in &mut movements {
        let gait = robot.gait(&movement.gait);
        let gait = gait.ok_or_else(|| IdentifyError::NoSuchGait(movement.gait.clone()))?;
        if !gait.has_movement() {
            return Err(IdentifyError::MovesNoServo(movement.gait.clone()));
        }
        let values = movement.mean.iter().chain(&movement.error);
        let are_all_finite = values
            .chain([&movement.pace])
            .all(|value| value.is_finite());
        let has_negative_error = movement.error.iter().any(|error| *error < 0.0);
        if !are_all_finite || movement.pace <= 0.0 || has_negative_error {
            return Err(IdentifyError::InvalidValue(movement.gait.clone()));
        }
        let prediction = robot.predict(gait);
        let components = [prediction.forward, prediction.left, prediction.turn];
        for (error, component) in movement.error.iter_mut().zip(components) {
            if component.is_none() {
                *error = f64::INFINITY;
            }
        }
        gait_runs.push((gait, movement.pace));
    }
    let motors = robot.motors();
    let predict = |values: &Values| -> Vec<Travel> {
        let mut ground = *robot.ground();
        for (key, value) in KEYS.iter().zip(values) {
            key.write_value(&mut ground, *value);
        }
        run_all(gait_runs.len(), &|i| {
            let (gait, pace): (&CheckedGait, f64) = gait_runs[i];
            gait.simulate_driven_cycle(&ground, &motors, pace)
        })
    };
    let file_values = std::array::from_fn(|i| KEYS[i].read_value(robot.ground()));
    identify_with_model(&movements, file_values, &predict)
}

/// Identifies the keys with which the model `predict` best reproduces the measured movements.
pub(crate) fn identify_with_model(
    movements: &[MeasuredMovement],
    file_values: Values,
    predict: &dyn Fn(&Values) -> Vec<Travel>,
) -> Result<Identification, IdentifyError> {
    let problem = Problem::new(movements, file_values, predict);
    if problem.measured_value_count() == 0 {
        return Err(IdentifyError::NothingDetermined);
    }
    let card_unknowns: Vec<usize> = (KEY_COUNT..UNKNOWN_COUNT).collect();
    let full_fit = fit_all(&problem)?;
    let degrees_of_freedom = compute_degrees_of_freedom(&problem, &full_fit);
    let has_freedom = degrees_of_freedom >= 1.0;
    let chi_square_limit = match has_freedom {
        true => compute_percentile_99(degrees_of_freedom),
        false => 0.0,
    };
    // Deviations that the model does not explain widen the errors of the keys (ratio of Birge, 1932).
    let error_factor = match has_freedom {
        true => (full_fit.chi_square / degrees_of_freedom).sqrt().max(1.0),
        false => 1.0,
    };
    let errors = compute_standard_errors(&problem, &full_fit).map(|error| error_factor * error);
    let (last_fit, verdicts) = choose_keys(&problem, &full_fit, &errors)?;
    let card_only_fit = problem.fit(&card_unknowns, &problem.start);
    let card_only_fit = card_only_fit.ok_or(IdentifyError::NoFit)?;
    let residuals = problem.compute_residuals(&last_fit.unknowns);
    let indexed_residuals = residuals.iter().enumerate();
    let largest_residual = indexed_residuals.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let (index, residual) = largest_residual.ok_or(IdentifyError::NothingDetermined)?;
    let (new_values, card) = split_unknowns(&last_fit.unknowns);
    let key_results = KEYS.iter().enumerate().map(|(i, key)| KeyResult {
        key,
        file_value: file_values[i],
        new_value: new_values[i],
        error: errors[i],
        verdict: verdicts[i],
    });
    let movements_before = problem.predict_card_movements(&card_only_fit.unknowns);
    let movements_after = problem.predict_card_movements(&last_fit.unknowns);
    let indexed_movements = movements.iter().enumerate();
    let movement_results = indexed_movements.map(|(i, movement)| MovementResult {
        measured: movement.clone(),
        predicted_before: movements_before[i],
        predicted_after: movements_after[i],
    });
    Ok(Identification {
        keys: key_results.collect(),
        card,
        card_error: split_unknowns(&errors).1,
        correlated_pairs: find_correlated_pairs(&full_fit.covariance),
        goodness: GoodnessOfFit {
            value_count: problem.measured_value_count(),
            chi_squares: [&card_only_fit, &last_fit, &full_fit].map(|fit| fit.chi_square),
            degrees_of_freedom,
            chi_square_limit,
            is_explained: !has_freedom || full_fit.chi_square <= chi_square_limit,
            error_factor,
            largest_residual: (index / 3, index % 3, *residual),
        },
        movements: movement_results.collect(),
    })
}

/// Fits all unknowns, from several start points if the first fit is poor.
///
/// The model is not linear: another foot length changes which feet carry the body, and small play may have no effect
/// at all. Therefore the first fit may end in a local minimum. If its sum of squares is larger than a correct model's
/// average, the fit is repeated from other start points, in each of which one nonlinear key is one prior standard
/// deviation above or below the file's value. The threshold is not the limit that only 1 % of correct models exceed,
/// because even a local minimum may be below that limit.
fn fit_all(problem: &Problem) -> Result<Fit, IdentifyError> {
    let all_unknowns: Vec<usize> = (0..UNKNOWN_COUNT).collect();
    let start = problem.start;
    let other_starts = NONLINEAR_KEYS.iter().flat_map(|&i| {
        [1.0, -1.0].map(|sign| {
            let mut guess = start;
            guess[i] = (start[i] + sign * problem.prior_errors[i]).max(KEYS[i].min_value);
            guess
        })
    });
    let mut best_fit: Option<Fit> = None;
    for guess in std::iter::once(start).chain(other_starts) {
        let Some(full_fit) = problem.fit(&all_unknowns, &guess) else {
            continue;
        };
        let degrees_of_freedom = compute_degrees_of_freedom(problem, &full_fit);
        let is_typical = degrees_of_freedom < 1.0 || full_fit.chi_square <= degrees_of_freedom;
        let is_better = |best_fit: &Fit| full_fit.chi_square < best_fit.chi_square;
        if best_fit.as_ref().is_none_or(is_better) {
            best_fit = Some(full_fit);
        }
        if is_typical {
            break;
        }
    }
    best_fit.ok_or(IdentifyError::NoFit)
}

/// Computes the standard errors of a fit of all unknowns.
///
/// The errors from the derivatives are exact only for a linear model. The contact model has kinks: a slightly longer
/// foot takes over a load, but an even longer foot has no further effect. Therefore each key is shifted by two standard
/// errors in both directions, and the other unknowns follow according to their correlation with the key. In a linear
/// model, the sum of squares rises by four. If the rise is smaller, the error is enlarged accordingly.
fn compute_standard_errors(problem: &Problem, full_fit: &Fit) -> Unknowns {
    let min_sum = problem.compute_sum_of_squares(&full_fit.unknowns);
    std::array::from_fn(|i| {
        let error = full_fit.covariance[(i, i)].max(0.0).sqrt();
        if i >= KEY_COUNT || error > MAX_ERROR_FRACTION * problem.prior_errors[i] {
            return error;
        }
        let compute_rise = |sign: f64| {
            let shifted = |j: usize| {
                full_fit.unknowns[j]
                    + sign * MIN_SIGNIFICANT_DISTANCE * full_fit.covariance[(j, i)] / error
            };
            problem.compute_sum_of_squares(&std::array::from_fn(shifted)) - min_sum
        };
        let rise = compute_rise(1.0).min(compute_rise(-1.0)).max(MIN_RISE);
        error * (MIN_SIGNIFICANT_DISTANCE / rise.sqrt()).max(1.0)
    })
}

/// Computes the degrees of freedom of a fit of all unknowns: the number of measured values minus, for each unknown, the
/// fraction that the measurements determine instead of the prior.
fn compute_degrees_of_freedom(problem: &Problem, full_fit: &Fit) -> f64 {
    let fractions = (0..UNKNOWN_COUNT)
        .map(|i| 1.0 - full_fit.covariance[(i, i)] / problem.prior_errors[i].powi(2));
    problem.measured_value_count() as f64 - fractions.sum::<f64>()
}

/// Holds keys at their file values, undetermined keys first, until every free key differs from its file value by at
/// least [`MIN_SIGNIFICANT_DISTANCE`]. Returns the last fit and the verdict on each key.
fn choose_keys(
    problem: &Problem,
    full_fit: &Fit,
    errors: &Unknowns,
) -> Result<(Fit, [Verdict; KEY_COUNT]), IdentifyError> {
    let mut verdicts = [Verdict::Changed; KEY_COUNT];
    let mut guess = full_fit.unknowns;
    let mut covariance = full_fit.covariance.clone();
    let start = &problem.start;
    for i in 0..KEY_COUNT {
        if errors[i] > MAX_ERROR_FRACTION * problem.prior_errors[i] {
            verdicts[i] = Verdict::Undetermined;
            hold_key(i, start, &mut guess, &mut covariance);
        }
    }
    loop {
        // Keys are first held in the linear model, since this needs no simulations.
        while let Some((i, verdict)) = find_key_to_hold(&verdicts, &guess, start, errors) {
            verdicts[i] = verdict;
            hold_key(i, start, &mut guess, &mut covariance);
        }
        let is_free = |i: &usize| *i >= KEY_COUNT || verdicts[*i] == Verdict::Changed;
        let free_unknowns: Vec<usize> = (0..UNKNOWN_COUNT).filter(is_free).collect();
        let last_fit = problem.fit(&free_unknowns, &guess);
        let last_fit = last_fit.ok_or(IdentifyError::NoFit)?;
        guess = last_fit.unknowns;
        if find_key_to_hold(&verdicts, &guess, start, errors).is_none() {
            return Ok((last_fit, verdicts));
        }
    }
}

/// Finds the index of the next key to hold at its file value, and its verdict; returns `None` if all free keys may
/// change.
fn find_key_to_hold(
    verdicts: &[Verdict; KEY_COUNT],
    unknowns: &Unknowns,
    start: &Unknowns,
    errors: &Unknowns,
) -> Option<(usize, Verdict)> {
    let free_keys = || (0..KEY_COUNT).filter(|&i| verdicts[i] == Verdict::Changed);
    let distance = |i: usize| (unknowns[i] - start[i]).abs() / errors[i];
    let nearest_key = free_keys().min_by(|&a, &b| distance(a).total_cmp(&distance(b)))?;
    if distance(nearest_key) < MIN_SIGNIFICANT_DISTANCE {
        return Some((nearest_key, Verdict::Unchanged));
    }
    let infeasible_key = free_keys().find(|&i| unknowns[i] < KEYS[i].min_value)?;
    let verdict = Verdict::Impossible(unknowns[infeasible_key]);
    Some((infeasible_key, verdict))
}

/// Holds the key with the index `held` at its file value, and shifts the other unknowns and the covariance according to
/// the correlations.
fn hold_key(held: usize, start: &Unknowns, unknowns: &mut Unknowns, covariance: &mut DMatrix<f64>) {
    let variance = covariance[(held, held)];
    let column: Vec<f64> = covariance.column(held).iter().copied().collect();
    let shift = (unknowns[held] - start[held]) / variance;
    for i in 0..UNKNOWN_COUNT {
        unknowns[i] -= column[i] * shift;
        for j in 0..UNKNOWN_COUNT {
            covariance[(i, j)] -= column[i] * column[j] / variance;
        }
    }
    unknowns[held] = start[held];
}

/// Finds the pairs of keys with strongly correlated errors; returns the keys and their correlation.
fn find_correlated_pairs(covariance: &DMatrix<f64>) -> Vec<(&'static Key, &'static Key, f64)> {
    let pairs = (0..KEY_COUNT).flat_map(|j| (0..j).map(move |i| (i, j)));
    let correlated = pairs.map(|(i, j)| {
        let scale = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        (&KEYS[i], &KEYS[j], covariance[(i, j)] / scale)
    });
    let is_strong = |(_, _, correlation): &(_, _, f64)| correlation.abs() > MIN_CORRELATION;
    correlated.filter(is_strong).collect()
}

#[cfg(test)]
mod tests;
