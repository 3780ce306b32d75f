//! The range of a prediction over the plausible values of what it assumes.

use lizard_robot::{CheckedGait, MovementRange, Robot};
use serde::Serialize;

use crate::part::PARTS;

/// The predicted way ahead or turn of a cycle if one assumption at a time takes the ends of its plausible range.
#[derive(Debug, Serialize)]
pub(crate) struct Range {
    /// The part of the movement, one of [`PARTS`].
    part: &'static str,
    /// mm or deg.
    least: f64,
    most: f64,
    /// The assumptions that make it so; null for those of robot.toml.
    least_by: Option<&'static str>,
    most_by: Option<&'static str>,
}

impl Range {
    /// The range of a gait at a pace, 1 for its own.
    pub(crate) fn of(robot: &Robot, gait: &CheckedGait, pace: f64) -> Self {
        let range = MovementRange::of(robot, gait, pace);
        let [least, most] = [range.least, range.most];
        Self {
            part: PARTS[if range.is_turn { 2 } else { 0 }],
            least: least.movement,
            most: most.movement,
            least_by: least.assumption,
            most_by: most.assumption,
        }
    }

    /// The line of a table.
    pub(crate) fn line(&self) -> String {
        let (name, unit) = self.part.split_once(", ").unwrap_or((self.part, ""));
        let end = |movement: f64, by: Option<&str>| {
            let by = by.unwrap_or("as in robot.toml");
            format!("{movement:+.2} {unit} ({by})")
        };
        let least = end(self.least, self.least_by);
        let most = end(self.most, self.most_by);
        format!("predicted {name} if one assumption is otherwise: {least} to {most}\n")
    }
}
