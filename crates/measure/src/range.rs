//! The range of a prediction while one of its assumptions varies over its plausible values.

use lizard_robot::{CheckedGait, MovementRange, Robot};
use serde::Serialize;

use crate::component::COMPONENT_NAMES;

/// The smallest and the largest predicted movement per cycle, forward or as a turn, while one assumption at a time is
/// set to either end of its plausible range.
#[derive(Debug, Serialize)]
pub(crate) struct PredictionRange {
    /// The component of the movement, one of [`COMPONENT_NAMES`].
    part: &'static str,
    /// The smallest predicted movement, mm or deg.
    least: f64,
    /// The largest predicted movement, mm or deg.
    most: f64,
    /// The assumption whose change gives `least`; null if it is the prediction by robot.toml.
    least_by: Option<&'static str>,
    /// The assumption whose change gives `most`; null if it is the prediction by robot.toml.
    most_by: Option<&'static str>,
}

impl PredictionRange {
    /// Computes the range of a gait at a pace, which is a multiple of the gait's own.
    pub(crate) fn compute(robot: &Robot, gait: &CheckedGait, pace: f64) -> Self {
        let movement_range = MovementRange::of(robot, gait, pace);
        let (smallest, largest) = (movement_range.smallest, movement_range.largest);
        Self {
            part: COMPONENT_NAMES[if movement_range.is_turn { 2 } else { 0 }],
            least: smallest.movement,
            most: largest.movement,
            least_by: smallest.assumption,
            most_by: largest.assumption,
        }
    }

    /// The range as a line of text.
    pub(crate) fn line(&self) -> String {
        let (name, unit) = self.part.split_once(", ").unwrap_or((self.part, ""));
        let end_text = |movement: f64, assumption: Option<&str>| {
            let assumption = assumption.unwrap_or("as in robot.toml");
            format!("{movement:+.2} {unit} ({assumption})")
        };
        let least_text = end_text(self.least, self.least_by);
        let most_text = end_text(self.most, self.most_by);
        format!("predicted {name} if one assumption is otherwise: {least_text} to {most_text}\n")
    }
}
