//! A printed equation, its correction, and the errors of both against the geometric solution at a sample.

use super::sample::Sample;

/// A function that returns the error of a form at a sample; `None` if the form has no real value there.
pub type ErrorFn = fn(&Sample) -> Option<f64>;

/// A printed equation.
pub struct Equation {
    /// The equation's place in the paper.
    pub place: &'static str,
    /// The equation as printed.
    pub printed: &'static str,
    /// The error of the printed form.
    pub miss: ErrorFn,
    /// Unit of every error of this equation.
    pub unit: &'static str,
    /// The error if right-hand angles are read clockwise from -x, where the paper's drawing
    /// suggests it.
    pub clockwise: Option<ErrorFn>,
    /// The corrected form, and its error.
    pub corrected: Option<(&'static str, ErrorFn)>,
    /// A special case, and the error of the printed form in that case; it does not affect the verdict.
    pub special_case: Option<(&'static str, ErrorFn)>,
}

impl Equation {
    /// Creates an equation without a correction; `miss` returns the error of the printed form in `unit`.
    pub const fn new(
        place: &'static str,
        printed: &'static str,
        unit: &'static str,
        miss: ErrorFn,
    ) -> Self {
        Self {
            place,
            printed,
            miss,
            unit,
            clockwise: None,
            corrected: None,
            special_case: None,
        }
    }

    /// Adds the error if right-hand angles are read clockwise from -x.
    pub const fn clockwise(mut self, miss: ErrorFn) -> Self {
        self.clockwise = Some(miss);
        self
    }

    /// Adds the corrected form and its error.
    pub const fn corrected(mut self, form: &'static str, miss: ErrorFn) -> Self {
        self.corrected = Some((form, miss));
        self
    }

    /// Adds a special case, and the error of the printed form in that case.
    pub const fn with_special_place(mut self, place: &'static str, miss: ErrorFn) -> Self {
        self.special_case = Some((place, miss));
        self
    }
}

/// The errors of a form over all samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misses {
    /// The largest error among samples with a real value.
    pub worst: f64,
    /// Share of the samples without a real value.
    pub unreal: f64,
}

impl Misses {
    /// Errors below this are rounding errors, in any unit.
    const ROUNDING: f64 = 1e-6;

    /// Evaluates a form at all samples.
    pub fn of(miss: ErrorFn, samples: &[Sample]) -> Self {
        let mut worst = 0.0_f64;
        let mut unreal_count = 0usize;
        for sample in samples {
            match miss(sample) {
                Some(value) if value.is_finite() => worst = worst.max(value),
                _ => unreal_count += 1,
            }
        }
        Self {
            worst,
            unreal: unreal_count as f64 / samples.len().max(1) as f64,
        }
    }

    /// True if the form has a real value at every sample, and its errors are only from rounding.
    pub fn holds(&self) -> bool {
        self.worst < Self::ROUNDING && self.unreal == 0.0
    }
}
