//! A printed equation, its correction, and the errors of both against the geometric solution at a sample.

use super::sample::Sample;

/// A function that returns the error of a form at a sample; `None` if the form has no real value there.
pub type ErrorFn = fn(&Sample) -> Option<f64>;

/// A printed equation.
pub struct Equation {
    /// The equation's section and name in the paper.
    pub location: &'static str,
    /// The equation as printed.
    pub printed_form: &'static str,
    /// The error of the printed form.
    pub printed_error: ErrorFn,
    /// Unit of every error of this equation.
    pub unit: &'static str,
    /// The error of the printed form with the angles of the robot's right side measured clockwise from -x; `None` if
    /// the paper's drawings do not suggest this convention.
    pub clockwise_error: Option<ErrorFn>,
    /// The corrected form and its error.
    pub correction: Option<(&'static str, ErrorFn)>,
    /// A special case, and the error of the printed form in this case. The special case does not affect the verdict.
    pub special_case: Option<(&'static str, ErrorFn)>,
}

impl Equation {
    /// Creates an equation without a correction. `printed_error` returns the error of the printed form in `unit`.
    pub const fn new(
        location: &'static str,
        printed_form: &'static str,
        unit: &'static str,
        printed_error: ErrorFn,
    ) -> Self {
        Self {
            location,
            printed_form,
            printed_error,
            unit,
            clockwise_error: None,
            correction: None,
            special_case: None,
        }
    }

    /// Adds the error of the printed form with the angles of the robot's right side measured clockwise from -x.
    pub const fn with_clockwise_error(mut self, error_fn: ErrorFn) -> Self {
        self.clockwise_error = Some(error_fn);
        self
    }

    /// Adds the corrected form and its error.
    pub const fn with_correction(mut self, form: &'static str, error_fn: ErrorFn) -> Self {
        self.correction = Some((form, error_fn));
        self
    }

    /// Adds a special case, and the error of the printed form in this case.
    pub const fn with_special_case(
        mut self,
        special_case: &'static str,
        error_fn: ErrorFn,
    ) -> Self {
        self.special_case = Some((special_case, error_fn));
        self
    }
}

/// Statistics of a form's errors over all samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormErrors {
    /// The largest error among samples with a real value.
    pub max: f64,
    /// Fraction of the samples without a real value.
    pub no_real_value_fraction: f64,
}

impl FormErrors {
    /// Errors below this value are rounding errors, in any unit.
    const MAX_ROUNDING: f64 = 1e-6;

    /// Evaluates a form at all samples.
    pub fn evaluate(error_fn: ErrorFn, samples: &[Sample]) -> Self {
        let mut max = 0.0_f64;
        let mut no_real_value_count = 0usize;
        for sample in samples {
            match error_fn(sample) {
                Some(value) if value.is_finite() => max = max.max(value),
                _ => no_real_value_count += 1,
            }
        }
        Self {
            max,
            no_real_value_fraction: no_real_value_count as f64 / samples.len().max(1) as f64,
        }
    }

    /// True if the form has a real value at every sample, and all its errors are rounding errors.
    pub fn holds(&self) -> bool {
        self.max < Self::MAX_ROUNDING && self.no_real_value_fraction == 0.0
    }
}
