//! Nonlinear least squares by the Levenberg-Marquardt method, for a few dozen parameters.

use nalgebra::{DMatrix, DVector};

/// Largest number of iterations.
const MAX_ITERATIONS: usize = 60;
/// Smallest relative reduction of the sum of squares per iteration; below it, the fit ends.
const MIN_RELATIVE_REDUCTION: f64 = 1e-10;

/// The parameters that minimise the sum of squares.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    /// The parameters with the best fit.
    pub parameters: Vec<f64>,
    /// The covariance of the parameters for residuals with a variance of one.
    pub covariance: DMatrix<f64>,
    /// The sum of the squared residuals.
    pub sum_of_squares: f64,
}

/// Finds the parameters that minimise the sum of the squared residuals; `None` if a parameter has no influence or a
/// result is not finite.
pub(crate) fn fit(start: &[f64], residuals: impl Fn(&[f64]) -> Vec<f64>) -> Option<Fit> {
    let mut parameters = start.to_vec();
    let mut current_residuals = residuals(&parameters);
    let mut sum_of_squares = squared_norm(&current_residuals);
    let mut damping = 1e-4;
    let mut normal_matrix = DMatrix::zeros(parameters.len(), parameters.len());
    for _ in 0..MAX_ITERATIONS {
        let jacobian = compute_jacobian(&parameters, current_residuals.len(), &residuals);
        normal_matrix = jacobian.tr_mul(&jacobian);
        let gradient = jacobian.tr_mul(&DVector::from_column_slice(&current_residuals));
        let mut relative_reduction = None;
        for _ in 0..12 {
            let mut damped = normal_matrix.clone();
            for i in 0..parameters.len() {
                damped[(i, i)] += damping * normal_matrix[(i, i)].max(1e-12);
            }
            let step = damped.cholesky()?.solve(&gradient);
            let next_parameters = DVector::from_column_slice(&parameters) - step;
            let next_parameters = next_parameters.as_slice().to_vec();
            let next_residuals = residuals(&next_parameters);
            let next_sum = squared_norm(&next_residuals);
            if next_sum <= sum_of_squares {
                relative_reduction = Some((sum_of_squares - next_sum) / sum_of_squares.max(1e-300));
                (parameters, current_residuals, sum_of_squares) =
                    (next_parameters, next_residuals, next_sum);
                damping = (damping / 10.0).max(1e-12);
                break;
            }
            damping *= 10.0;
        }
        if relative_reduction.is_none_or(|reduction| reduction < MIN_RELATIVE_REDUCTION) {
            break;
        }
    }
    let covariance = normal_matrix.try_inverse()?;
    let is_finite = sum_of_squares.is_finite() && covariance.iter().all(|value| value.is_finite());
    is_finite.then_some(Fit {
        parameters,
        covariance,
        sum_of_squares,
    })
}

/// Returns the sum of the squared values.
pub(crate) fn squared_norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

/// Computes the variance of a value that is computed from parameters with this covariance. `gradient` has the value's
/// derivative with respect to each parameter.
pub(crate) fn propagate_variance(gradient: &[f64], covariance: &DMatrix<f64>) -> f64 {
    let count = gradient.len();
    let pairs = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
    let terms = pairs.map(|(i, j)| gradient[i] * covariance[(i, j)] * gradient[j]);
    terms.sum::<f64>().max(0.0)
}

/// Computes the derivatives of the residuals with respect to the parameters, from central differences.
fn compute_jacobian(
    parameters: &[f64],
    residual_count: usize,
    residuals: &impl Fn(&[f64]) -> Vec<f64>,
) -> DMatrix<f64> {
    let mut jacobian = DMatrix::zeros(residual_count, parameters.len());
    for (column, value) in parameters.iter().enumerate() {
        let increment = 1e-6 * value.abs().max(1e-2);
        let residuals_at = |shift: f64| {
            let mut shifted = parameters.to_vec();
            shifted[column] += shift;
            residuals(&shifted)
        };
        let (plus, minus) = (residuals_at(increment), residuals_at(-increment));
        for (row, (plus, minus)) in plus.iter().zip(&minus).enumerate() {
            jacobian[(row, column)] = (plus - minus) / (2.0 * increment);
        }
    }
    jacobian
}
