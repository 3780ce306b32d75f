//! The range of a prediction when one assumption at a time is moved to an end of its plausible range.

use lizard_robot::{CheckedGait, DisplacementRange, Robot};
use serde::Serialize;

use crate::component::COMPONENT_LABELS;

/// The smallest and the largest predicted movement per cycle, ahead or turn, when one assumption at a time is moved to
/// an end of its plausible range.
#[derive(Debug, Serialize)]
pub(crate) struct PredictionRange {
    /// The component of the movement, one of [`COMPONENT_LABELS`].
    #[serde(rename = "part")]
    component: &'static str,
    /// The smallest predicted movement, mm or deg.
    #[serde(rename = "least")]
    min: f64,
    /// The largest predicted movement, mm or deg.
    #[serde(rename = "most")]
    max: f64,
    /// The assumption whose change gives `min`; `None` if the values in robot.toml give it.
    #[serde(rename = "least_by")]
    min_assumption: Option<&'static str>,
    /// The assumption whose change gives `max`; `None` if the values in robot.toml give it.
    #[serde(rename = "most_by")]
    max_assumption: Option<&'static str>,
}

impl PredictionRange {
    /// Computes the range of a gait's prediction. `pace` is a multiple of the gait's nominal pace.
    pub(crate) fn compute(robot: &Robot, gait: &CheckedGait, pace: f64) -> Self {
        let displacement_range = DisplacementRange::compute(robot, gait, pace);
        let (smallest, largest) = (displacement_range.min, displacement_range.max);
        Self {
            component: COMPONENT_LABELS[if displacement_range.is_turn { 2 } else { 0 }],
            min: smallest.displacement,
            max: largest.displacement,
            min_assumption: smallest.assumption,
            max_assumption: largest.assumption,
        }
    }

    /// Formats the range as a line of text.
    pub(crate) fn format_line(&self) -> String {
        let (component_name, unit) = self.component.split_once(", ").unwrap_or_default();
        let format_bound = |movement: f64, assumption: Option<&str>| {
            let assumption = assumption.unwrap_or("as in robot.toml");
            format!("{movement:+.2} {unit} ({assumption})")
        };
        let min_text = format_bound(self.min, self.min_assumption);
        let max_text = format_bound(self.max, self.max_assumption);
        format!(
            "predicted {component_name} with one assumption changed: {min_text} to {max_text}\n"
        )
    }
}
