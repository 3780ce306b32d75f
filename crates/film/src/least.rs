//! Nonlinear least squares by the method of Levenberg and Marquardt, for a few dozen parameters.

use nalgebra::{DMatrix, DVector};

/// Largest number of steps.
const STEPS: usize = 60;
/// Relative decrease of the sum of squares in a step, below which the fit ends.
const ENOUGH: f64 = 1e-10;

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
    let sum = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    let mut at = start.to_vec();
    let mut here = residuals(&at);
    let mut squares = sum(&here);
    let mut damping = 1e-4;
    let mut normal = DMatrix::zeros(at.len(), at.len());
    for _ in 0..STEPS {
        let jacobian = jacobian(&at, here.len(), &residuals);
        normal = jacobian.tr_mul(&jacobian);
        let gradient = jacobian.tr_mul(&DVector::from_column_slice(&here));
        let mut gained = None;
        for _ in 0..12 {
            let mut damped = normal.clone();
            for i in 0..at.len() {
                damped[(i, i)] += damping * normal[(i, i)].max(1e-12);
            }
            let step = damped.cholesky()?.solve(&gradient);
            let next: Vec<f64> = at.iter().zip(step.iter()).map(|(a, s)| a - s).collect();
            let there = residuals(&next);
            let less = sum(&there);
            if less <= squares {
                gained = Some((squares - less) / squares.max(1e-300));
                (at, here, squares) = (next, there, less);
                damping = (damping / 10.0).max(1e-12);
                break;
            }
            damping *= 10.0;
        }
        if gained.is_none_or(|gained| gained < ENOUGH) {
            break;
        }
    }
    let covariance = normal.try_inverse()?;
    let is_known = squares.is_finite() && covariance.iter().all(|part| part.is_finite());
    is_known.then_some(Fit {
        at,
        covariance,
        squares,
    })
}

/// The derivatives of the residuals, by central differences.
fn jacobian(at: &[f64], count: usize, residuals: &impl Fn(&[f64]) -> Vec<f64>) -> DMatrix<f64> {
    let mut jacobian = DMatrix::zeros(count, at.len());
    for (column, value) in at.iter().enumerate() {
        let step = 1e-6 * value.abs().max(1e-2);
        let moved = |by: f64| {
            let mut moved = at.to_vec();
            moved[column] += by;
            residuals(&moved)
        };
        for (row, (plus, minus)) in moved(step).iter().zip(moved(-step)).enumerate() {
            jacobian[(row, column)] = (plus - minus) / (2.0 * step);
        }
    }
    jacobian
}
