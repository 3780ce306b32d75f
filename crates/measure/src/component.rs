//! A component of a movement (forward, left or turn), compared with its prediction.

use lizard_video::Mean;
use serde::Serialize;

/// Largest difference of a component from its prediction that counts as agreement, standard errors.
pub const AGREEMENT_LIMIT: f64 = 2.0;
/// The labels of a movement's components: names and units.
pub const COMPONENT_LABELS: [&str; 3] = ["ahead, mm", "left, mm", "turn, deg"];

/// A measured component of a movement and its prediction.
#[derive(Debug, Serialize)]
pub struct Component {
    /// Mean over the cycles, mm or deg.
    pub mean: f64,
    /// Standard deviation of single cycles, mm or deg.
    #[serde(rename = "sd")]
    standard_deviation: f64,
    /// Standard error of the mean, mm or deg.
    #[serde(rename = "error")]
    pub standard_error: f64,
    /// The prediction; `None` if it is undetermined because two feet pull against the other two.
    pub predicted: Option<f64>,
    /// The mean minus the prediction, in standard errors; `None` if there is no prediction.
    #[serde(rename = "differs")]
    difference: Option<f64>,
    /// True if the difference is at most [`AGREEMENT_LIMIT`]; `None` if there is no prediction.
    pub(crate) agrees: Option<bool>,
}

/// Describes a difference, given in standard errors: `agrees`, or its size and direction.
pub fn format_verdict(difference: f64) -> String {
    match difference.abs() {
        size if size <= AGREEMENT_LIMIT => "agrees".to_owned(),
        size if difference > 0.0 => format!("{size:.1} std. errors more"),
        size => format!("{size:.1} std. errors less"),
    }
}

impl Component {
    pub(crate) fn new(mean: Mean, predicted: Option<f64>) -> Self {
        // A simulated video may have no spread; the bound avoids a division by zero.
        let difference =
            predicted.map(|predicted| (mean.value - predicted) / mean.standard_error.max(1e-6));
        Self {
            mean: mean.value,
            standard_deviation: mean.standard_deviation,
            standard_error: mean.standard_error,
            predicted,
            difference,
            agrees: difference.map(|difference| difference.abs() <= AGREEMENT_LIMIT),
        }
    }

    /// Describes the difference from the prediction: `agrees`, its size and direction, or `-` if nothing is predicted.
    pub fn format_verdict(&self) -> String {
        self.difference.map_or("-".to_owned(), format_verdict)
    }

    /// Formats the component as a line of a table.
    pub(crate) fn format_line(&self, label: &str) -> String {
        let predicted = self
            .predicted
            .map_or("-".to_owned(), |value| format!("{value:+.2}"));
        format!(
            "{label:<12}{:>+9.2}{:>8.2}{:>8.2}{predicted:>11}   {}\n",
            self.mean,
            self.standard_deviation,
            self.standard_error,
            self.format_verdict()
        )
    }
}
