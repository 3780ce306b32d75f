//! A component of a movement (forward, left or turn) beside its prediction.

use lizard_film::Mean;
use serde::Serialize;

/// Largest difference from the prediction, in standard errors, that counts as agreement.
pub const MAX_AGREEING_ERRORS: f64 = 2.0;
/// The names of a movement's components, with their units.
pub const COMPONENT_NAMES: [&str; 3] = ["ahead, mm", "left, mm", "turn, deg"];

/// A measured component of a movement, beside its prediction.
#[derive(Debug, Serialize)]
pub struct Component {
    /// The mean, mm or deg.
    pub mean: f64,
    /// Standard deviation of single cycles, mm or deg.
    sd: f64,
    /// Standard error of the mean, mm or deg.
    pub error: f64,
    /// The prediction; `None` if it is undetermined because two feet pull against the other two.
    pub predicted: Option<f64>,
    /// The mean minus the prediction, in standard errors; `None` without a prediction.
    differs: Option<f64>,
    /// True if the difference is at most [`MAX_AGREEING_ERRORS`]; `None` without a prediction.
    pub(crate) agrees: Option<bool>,
}

/// Describes a difference, given in standard errors: `agrees`, or its size and direction.
pub fn verdict(difference_in_errors: f64) -> String {
    if difference_in_errors.abs() <= MAX_AGREEING_ERRORS {
        return "agrees".to_owned();
    }
    let word = if difference_in_errors > 0.0 {
        "more"
    } else {
        "less"
    };
    format!("{:.1} errors {word}", difference_in_errors.abs())
}

impl Component {
    pub(crate) fn new(mean: Mean, predicted: Option<f64>) -> Self {
        // A simulated film may have no spread; the bound avoids a division by zero.
        let differs =
            predicted.map(|predicted| (mean.value - predicted) / mean.standard_error.max(1e-6));
        Self {
            mean: mean.value,
            sd: mean.standard_deviation,
            error: mean.standard_error,
            predicted,
            differs,
            agrees: differs.map(|differs| differs.abs() <= MAX_AGREEING_ERRORS),
        }
    }

    /// Describes the difference from the prediction: `agrees`, or its size and direction, or `-` without a prediction.
    pub fn verdict(&self) -> String {
        self.differs.map_or("-".to_owned(), verdict)
    }

    /// The component's line of a table.
    pub(crate) fn line(&self, name: &str) -> String {
        let predicted = self
            .predicted
            .map_or("-".to_owned(), |value| format!("{value:+.2}"));
        format!(
            "{name:<12}{:>+9.2}{:>8.2}{:>8.2}{predicted:>11}   {}\n",
            self.mean,
            self.sd,
            self.error,
            self.verdict()
        )
    }
}
