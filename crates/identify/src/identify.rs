//! The fit of all keys, and the choice of the keys whose value changes.
//!
//! First all keys are free. The reported standard errors are those of this fit, because the file's values enter it only
//! through wide priors. Then keys return to their file values one at a time. The next key is always the one that is
//! nearest to its file value, measured in its standard errors. Keys return as long as this distance is less than two.
//! After each return the free keys are adjusted. So if two keys have the same effect, only one of them changes.

use lizard_robot::{CheckedGait, Robot, Travel};
use nalgebra::DMatrix;

use crate::card::{self, Card};
use crate::chi_square::percentile_99;
use crate::error::IdentifyError;
use crate::key::{FRICTION_RATIO_INDEX, KEY_COUNT, KEYS, PLAY_INDEX, TWIST_INDEX};
use crate::movement::MeasuredMovement;
use crate::outcome::{GoodnessOfFit, Identified, KeyResult, MovementResult, Verdict};
use crate::problem::{Problem, Solution, UNKNOWN_COUNT, Values, split};

/// Indices in [`KEYS`] of the keys for which the model is least linear near the file's value.
const NONLINEAR_KEYS: [usize; 3] = [PLAY_INDEX, TWIST_INDEX, FRICTION_RATIO_INDEX];
/// Smallest distance from the file's value, in standard errors, at which a key takes its new value.
const MIN_DISTANCE_ERRORS: f64 = 2.0;
/// Lower bound for the rise of the sum of squares when a key is shifted by [`MIN_DISTANCE_ERRORS`] standard errors. A
/// smaller rise may be only roughness of the model. The bound limits the enlargement of an error to a factor of four.
const MIN_RISE: f64 = 0.25;
/// Largest standard error of a key that counts as determined, as a share of its prior standard deviation.
const MAX_ERROR_SHARE: f64 = 0.5;
/// Correlation of errors above which two keys are reported as hard to distinguish.
const MIN_CORRELATION: f64 = 0.8;

/// A function that runs a job for each index below a count, one after another or on all cores, and returns the results
/// in order.
pub type RunAll<'a> = &'a dyn Fn(usize, &(dyn Fn(usize) -> Travel + Sync)) -> Vec<Travel>;

/// Identifies the keys of a robot from its measured movements. `run_all` runs the simulations of the gaits: a few
/// hundred of about a tenth of a second each.
///
/// # Errors
/// Fails for a gait that the robot does not have or that moves no servo, for measured values that are not finite or out
/// of range, and if no movement determines a key.
pub fn identify(
    robot: &Robot,
    movements: &[MeasuredMovement],
    run_all: RunAll,
) -> Result<Identified, IdentifyError> {
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
        if !are_all_finite
            || movement.pace <= 0.0
            || movement.error.iter().any(|error| *error < 0.0)
        {
            return Err(IdentifyError::InvalidValue(movement.gait.clone()));
        }
        let prediction = robot.predict(gait);
        for (i, component) in [prediction.forward, prediction.left, prediction.turn]
            .iter()
            .enumerate()
        {
            if component.is_none() {
                movement.error[i] = f64::INFINITY;
            }
        }
        gait_runs.push((gait, movement.pace));
    }
    let motors = robot.motors();
    let predict = |values: &Values| -> Vec<Travel> {
        let mut ground = *robot.ground();
        for (key, value) in KEYS.iter().zip(values) {
            key.set(&mut ground, *value);
        }
        run_all(gait_runs.len(), &|i| {
            let (gait, pace): (&CheckedGait, f64) = gait_runs[i];
            gait.simulate_driven_cycle(&ground, &motors, pace)
        })
    };
    let file_values = std::array::from_fn(|i| KEYS[i].value_in(robot.ground()));
    solve(&movements, file_values, &predict)
}

/// Identifies the keys with which the model `predict` reproduces the measured movements.
pub(crate) fn solve(
    movements: &[MeasuredMovement],
    file_values: Values,
    predict: &dyn Fn(&Values) -> Vec<Travel>,
) -> Result<Identified, IdentifyError> {
    let problem = Problem::new(movements, file_values, predict);
    if problem.value_count() == 0 {
        return Err(IdentifyError::NothingDetermined);
    }
    let all_unknowns: Vec<usize> = (0..UNKNOWN_COUNT).collect();
    let Fit {
        solution: full_fit,
        degrees_of_freedom,
        chi_square_limit,
        is_explained,
    } = fit_all(&problem)?;
    // Deviations that the model does not explain widen the errors of the keys (ratio of Birge, 1932).
    let error_factor = match degrees_of_freedom < 1.0 {
        true => 1.0,
        false => (full_fit.chi_square / degrees_of_freedom).sqrt().max(1.0),
    };
    let errors = standard_errors(&problem, &full_fit).map(|error| error_factor * error);
    let (last_fit, verdicts) = choose_keys(&problem, &full_fit, &errors)?;
    let card_only_solution = problem.fit(&all_unknowns[KEY_COUNT..], &problem.start_unknowns());
    let card_only_fit = card_only_solution.ok_or(IdentifyError::NoFit)?;
    let residuals = problem
        .residuals(&last_fit.unknowns)
        .into_iter()
        .enumerate();
    let indexed_residuals = residuals.flat_map(|(movement, components)| {
        let components = components.into_iter().enumerate();
        components.map(move |(component, residual)| (movement, component, residual))
    });
    let largest_residual = indexed_residuals.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
    let new_values = split(&last_fit.unknowns).0;
    let key_result_of = |(i, key): (usize, &'static crate::Key)| KeyResult {
        key,
        file_value: file_values[i],
        new_value: new_values[i],
        error: errors[i],
        verdict: verdicts[i],
    };
    let predictions = problem
        .predicted_on_card(&card_only_fit.unknowns)
        .into_iter()
        .zip(problem.predicted_on_card(&last_fit.unknowns));
    let measured_and_predicted = movements.iter().zip(predictions);
    let result_of =
        |(movement, (predicted_before, predicted_after)): (&MeasuredMovement, _)| MovementResult {
            measured: movement.clone(),
            predicted_before,
            predicted_after,
        };
    let card_errors: [f64; card::PARAMETER_COUNT] = std::array::from_fn(|i| errors[KEY_COUNT + i]);
    Ok(Identified {
        keys: KEYS.iter().enumerate().map(key_result_of).collect(),
        card: split(&last_fit.unknowns).1,
        card_error: Card::from(card_errors),
        correlated_pairs: correlated_pairs(&full_fit.covariance),
        goodness: GoodnessOfFit {
            value_count: problem.value_count(),
            chi_squares: [
                card_only_fit.chi_square,
                last_fit.chi_square,
                full_fit.chi_square,
            ],
            degrees_of_freedom,
            chi_square_limit,
            is_explained,
            error_factor,
            largest_residual: largest_residual.ok_or(IdentifyError::NothingDetermined)?,
        },
        movements: measured_and_predicted.map(result_of).collect(),
    })
}

/// A fit of all unknowns, and its agreement with the measurements.
struct Fit {
    solution: Solution,
    degrees_of_freedom: f64,
    /// Sum of squares that 1 % of correct models exceed; 0 without a degree of freedom.
    chi_square_limit: f64,
    /// True if the model explains the measurements.
    is_explained: bool,
}

/// Fits all unknowns, from several starts if the first fit is poor.
///
/// The model is not linear: another foot length changes which feet carry the body, and small play may have no effect
/// at all. So the first fit may end in a local minimum. If it leaves a larger sum of squares than a correct model does
/// on average, it is repeated from other starts. In each of them, one nonlinear key is one prior standard deviation
/// above or below the file's value. The limit that 1 % of correct models exceed is not used here, because a local
/// minimum may also be below this limit.
fn fit_all(problem: &Problem) -> Result<Fit, IdentifyError> {
    let all_unknowns: Vec<usize> = (0..UNKNOWN_COUNT).collect();
    let start = problem.start_unknowns();
    let other_starts = NONLINEAR_KEYS.iter().flat_map(|&key| {
        [1.0, -1.0].map(|side| {
            let mut guess = start;
            guess[key] = (start[key] + side * problem.prior_errors[key]).max(KEYS[key].min_value);
            guess
        })
    });
    let mut best_fit: Option<Fit> = None;
    for guess in std::iter::once(start).chain(other_starts) {
        let Some(full_fit) = problem.fit(&all_unknowns, &guess) else {
            continue;
        };
        let degrees_of_freedom = degrees_of_freedom_of(problem, &full_fit);
        let chi_square_limit = if degrees_of_freedom < 1.0 {
            0.0
        } else {
            percentile_99(degrees_of_freedom)
        };
        let is_explained = degrees_of_freedom < 1.0 || full_fit.chi_square <= chi_square_limit;
        let is_typical = degrees_of_freedom < 1.0 || full_fit.chi_square <= degrees_of_freedom;
        let is_better = |best_fit: &Fit| full_fit.chi_square < best_fit.solution.chi_square;
        if best_fit.as_ref().is_none_or(is_better) {
            best_fit = Some(Fit {
                solution: full_fit,
                degrees_of_freedom,
                chi_square_limit,
                is_explained,
            });
        }
        if is_typical {
            break;
        }
    }
    best_fit.ok_or(IdentifyError::NoFit)
}

/// Standard errors of a fit of all unknowns.
///
/// The errors from the derivatives are exact only for a linear model. The contact model has folds: a foot that is a
/// little longer takes over a load, and an even longer foot changes nothing more. So each key is shifted by two
/// standard errors in both directions, and the other unknowns follow according to their correlation with the key. In a
/// linear model the sum of squares rises by four. If it rises less, the error is enlarged accordingly.
fn standard_errors(problem: &Problem, full_fit: &Solution) -> [f64; UNKNOWN_COUNT] {
    let min_cost = problem.cost(&full_fit.unknowns);
    std::array::from_fn(|i| {
        let error = full_fit.covariance[(i, i)].max(0.0).sqrt();
        if i >= KEY_COUNT || error > MAX_ERROR_SHARE * problem.prior_errors[i] {
            return error;
        }
        let rise_on_side = |side: f64| {
            let shifted_unknown_at = |j: usize| {
                full_fit.unknowns[j]
                    + side * MIN_DISTANCE_ERRORS * full_fit.covariance[(j, i)] / error
            };
            problem.cost(&std::array::from_fn(shifted_unknown_at)) - min_cost
        };
        let rise = rise_on_side(1.0).min(rise_on_side(-1.0)).max(MIN_RISE);
        error * (MIN_DISTANCE_ERRORS / rise.sqrt()).max(1.0)
    })
}

/// Degrees of freedom of a fit of all unknowns: the number of measured values minus, for each unknown, the share that
/// the measurements determine instead of the prior.
fn degrees_of_freedom_of(problem: &Problem, full_fit: &Solution) -> f64 {
    let shares = (0..UNKNOWN_COUNT)
        .map(|i| 1.0 - full_fit.covariance[(i, i)] / problem.prior_errors[i].powi(2));
    problem.value_count() as f64 - shares.sum::<f64>()
}

/// Returns keys to the file's values until every free key differs from its file value by at least
/// [`MIN_DISTANCE_ERRORS`] standard errors. Undetermined keys return first. Returns the last fit and the verdict on
/// each key.
fn choose_keys(
    problem: &Problem,
    full_fit: &Solution,
    errors: &[f64; UNKNOWN_COUNT],
) -> Result<(Solution, [Verdict; KEY_COUNT]), IdentifyError> {
    let mut verdicts = [Verdict::Changed; KEY_COUNT];
    let mut guess = full_fit.unknowns;
    let mut covariance = full_fit.covariance.clone();
    let start = problem.start_unknowns();
    for key in 0..KEY_COUNT {
        if errors[key] > MAX_ERROR_SHARE * problem.prior_errors[key] {
            verdicts[key] = Verdict::Undetermined;
            hold(key, &start, &mut guess, &mut covariance);
        }
    }
    loop {
        // Keys are first held in the linear model, because it needs no run of the gaits.
        while let Some((key, verdict)) = next_key_to_hold(&verdicts, &guess, &start, errors) {
            verdicts[key] = verdict;
            hold(key, &start, &mut guess, &mut covariance);
        }
        let is_free = |i: &usize| {
            verdicts
                .get(*i)
                .is_none_or(|verdict| *verdict == Verdict::Changed)
        };
        let free_unknowns: Vec<usize> = (0..UNKNOWN_COUNT).filter(is_free).collect();
        let last_fit = problem
            .fit(&free_unknowns, &guess)
            .ok_or(IdentifyError::NoFit)?;
        guess = last_fit.unknowns;
        if next_key_to_hold(&verdicts, &guess, &start, errors).is_none() {
            return Ok((last_fit, verdicts));
        }
    }
}

/// The next key to return to the file's value, and its verdict; `None` if all free keys may keep their new values.
fn next_key_to_hold(
    verdicts: &[Verdict; KEY_COUNT],
    unknowns: &[f64; UNKNOWN_COUNT],
    start: &[f64; UNKNOWN_COUNT],
    errors: &[f64; UNKNOWN_COUNT],
) -> Option<(usize, Verdict)> {
    let free_keys = || (0..KEY_COUNT).filter(|&i| verdicts[i] == Verdict::Changed);
    let distance_of = |i: usize| (unknowns[i] - start[i]).abs() / errors[i];
    let nearest_key = free_keys().min_by(|&a, &b| distance_of(a).total_cmp(&distance_of(b)))?;
    if distance_of(nearest_key) < MIN_DISTANCE_ERRORS {
        return Some((nearest_key, Verdict::Unchanged));
    }
    let infeasible_key = free_keys().find(|&i| unknowns[i] < KEYS[i].min_value)?;
    Some((
        infeasible_key,
        Verdict::Impossible(unknowns[infeasible_key]),
    ))
}

/// Holds a key at the file's value, and shifts the other unknowns according to their correlation with the key.
fn hold(
    key: usize,
    start: &[f64; UNKNOWN_COUNT],
    unknowns: &mut [f64; UNKNOWN_COUNT],
    covariance: &mut DMatrix<f64>,
) {
    let variance = covariance[(key, key)];
    let column: Vec<f64> = covariance.column(key).iter().copied().collect();
    let shift = (unknowns[key] - start[key]) / variance;
    for i in 0..UNKNOWN_COUNT {
        unknowns[i] -= column[i] * shift;
        for j in 0..UNKNOWN_COUNT {
            covariance[(i, j)] -= column[i] * column[j] / variance;
        }
    }
    unknowns[key] = start[key];
}

/// Pairs of keys whose errors are strongly correlated, with the correlation.
fn correlated_pairs(
    covariance: &DMatrix<f64>,
) -> Vec<(&'static crate::Key, &'static crate::Key, f64)> {
    let pairs = (0..KEY_COUNT).flat_map(|i| (0..i).map(move |j| (j, i)));
    let correlated = pairs.map(|(i, j)| {
        let scale = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        (&KEYS[i], &KEYS[j], covariance[(i, j)] / scale)
    });
    let is_strong = |(_, _, correlation): &(_, _, f64)| correlation.abs() > MIN_CORRELATION;
    correlated.filter(is_strong).collect()
}

#[cfg(test)]
mod tests;
