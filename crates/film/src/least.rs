//! Nonlinear least squares by the method of Levenberg and Marquardt, for a few dozen parameters.

use nalgebra::{DMatrix, DVector};

/// Largest number of steps.
const STEPS: usize = 60;
/// Relative decrease of the sum of squares in a step, below which the fit ends.
const MIN_GAIN: f64 = 1e-10;

/// The parameters with the smallest sum of squares.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    /// The parameters.
    pub at: Vec<f64>,
    /// The covariance of the parameters if the residuals have a variance of one.
    pub covariance: DMatrix<f64>,
    /// The sum of the squared residuals.
    pub squares: f64,
}

/// Fits parameters to any number of residuals; `None` if a parameter has no influence or a result is not finite.
pub(crate) fn fit(start: &[f64], residuals: impl Fn(&[f64]) -> Vec<f64>) -> Option<Fit> {
    let sum_of_squares = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    let mut parameters = start.to_vec();
    let mut errors = residuals(&parameters);
    let mut squares = sum_of_squares(&errors);
    let mut damping = 1e-4;
    let mut normal = DMatrix::zeros(parameters.len(), parameters.len());
    for _ in 0..STEPS {
        let jacobian = jacobian(&parameters, errors.len(), &residuals);
        normal = jacobian.tr_mul(&jacobian);
        let gradient = jacobian.tr_mul(&DVector::from_column_slice(&errors));
        let mut gain = None;
        for _ in 0..12 {
            let mut damped = normal.clone();
            for i in 0..parameters.len() {
                damped[(i, i)] += damping * normal[(i, i)].max(1e-12);
            }
            let step = damped.cholesky()?.solve(&gradient);
            let next: Vec<f64> = parameters
                .iter()
                .zip(step.iter())
                .map(|(a, s)| a - s)
                .collect();
            let next_errors = residuals(&next);
            let next_squares = sum_of_squares(&next_errors);
            if next_squares <= squares {
                gain = Some((squares - next_squares) / squares.max(1e-300));
                (parameters, errors, squares) = (next, next_errors, next_squares);
                damping = (damping / 10.0).max(1e-12);
                break;
            }
            damping *= 10.0;
        }
        if gain.is_none_or(|gain| gain < MIN_GAIN) {
            break;
        }
    }
    let covariance = normal.try_inverse()?;
    let is_known = squares.is_finite() && covariance.iter().all(|value| value.is_finite());
    is_known.then_some(Fit {
        at: parameters,
        covariance,
        squares,
    })
}

/// The derivatives of the residuals, by central differences.
fn jacobian(
    parameters: &[f64],
    count: usize,
    residuals: &impl Fn(&[f64]) -> Vec<f64>,
) -> DMatrix<f64> {
    let mut jacobian = DMatrix::zeros(count, parameters.len());
    for (column, value) in parameters.iter().enumerate() {
        let step = 1e-6 * value.abs().max(1e-2);
        let residuals_at = |shift: f64| {
            let mut shifted = parameters.to_vec();
            shifted[column] += shift;
            residuals(&shifted)
        };
        for (row, (plus, minus)) in residuals_at(step)
            .iter()
            .zip(residuals_at(-step))
            .enumerate()
        {
            jacobian[(row, column)] = (plus - minus) / (2.0 * step);
        }
    }
    jacobian
}
