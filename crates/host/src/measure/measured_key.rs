//! Measured keys of robot.toml, compared with the values in the file, as a table and as lines for robot.toml.

use std::fmt::Write as _;

use lizard_measure::{AGREEMENT_LIMIT, format_verdict};
use lizard_robot::edit::{KeyError, with_comment, with_number};
use lizard_video::Estimate;
use serde::Serialize;

/// A measured key of robot.toml.
#[derive(Serialize)]
pub(super) struct MeasuredKey {
    /// The key's table in robot.toml, such as `servo.A1`.
    table: String,
    /// The key's name in its table.
    #[serde(rename = "key")]
    pub(super) name: &'static str,
    #[serde(rename = "measured")]
    value: f64,
    /// The standard error of `value`.
    #[serde(rename = "error")]
    standard_error: f64,
    /// The value in robot.toml, converted to the supply voltage of the measurement.
    #[serde(rename = "robot")]
    robot_value: f64,
    /// The measured value minus the value in robot.toml, in standard errors.
    #[serde(rename = "differs")]
    difference: f64,
    /// True if the measurement's error explains the difference.
    agrees: bool,
    /// Number of decimals with which the values are printed.
    #[serde(skip)]
    decimals: usize,
    /// The ratio of the value in robot.toml to `robot_value`.
    #[serde(skip)]
    scale: f64,
}

impl MeasuredKey {
    /// Creates a key from its measured value and its value in robot.toml. `supply_factor` converts the latter to the
    /// supply voltage of the measurement.
    pub(super) fn new(
        table: &str,
        name: &'static str,
        decimals: usize,
        estimate: Estimate,
        file_value: f64,
        supply_factor: f64,
    ) -> Self {
        let robot_value = file_value * supply_factor;
        let difference = (estimate.value - robot_value) / estimate.standard_error.max(1e-9);
        Self {
            table: table.to_owned(),
            name,
            value: estimate.value,
            standard_error: estimate.standard_error,
            robot_value,
            difference,
            agrees: difference.abs() <= AGREEMENT_LIMIT,
            decimals,
            scale: 1.0 / supply_factor,
        }
    }

    /// Returns the measured value, its standard error and the value in robot.toml, all at the supply voltage for which
    /// robot.toml gives its value.
    fn file_values(&self) -> [f64; 3] {
        [self.value, self.standard_error, self.robot_value].map(|value| value * self.scale)
    }
}

/// Formats the measured keys as a table.
pub(super) fn format_table(keys: &[MeasuredKey]) -> String {
    let mut text = format!("{:<28}measured   error  robot.toml\n", "");
    for key in keys {
        let verdict = format_verdict(key.difference);
        let decimals = key.decimals;
        let _ = writeln!(
            text,
            "{:<28}{:>8.decimals$}{:>8.decimals$}{:>12.decimals$}   {verdict}",
            key.name, key.value, key.standard_error, key.robot_value
        );
    }
    text
}

/// Formats the measured keys as lines for robot.toml, for the supply voltage at which its values are given.
pub(super) fn format_toml_lines(keys: &[MeasuredKey]) -> String {
    let mut text = String::new();
    let mut table = "";
    for key in keys {
        if key.table != table {
            table = &key.table;
            let _ = writeln!(text, "[{table}]");
        }
        let (name, decimals) = (key.name, key.decimals);
        let [value, error, old_value] = key.file_values();
        let _ = writeln!(
            text,
            "{name} = {value:.decimals$} # measured, +- {error:.decimals$}; was {old_value:.decimals$}"
        );
    }
    text
}

/// True for the text of an earlier output with measured keys, which a new output may replace: each of its lines is a
/// measured key, a table header, blank, or a line of `robot_toml`, so it has no key, value or comment that a user has
/// changed.
pub(super) fn is_earlier_output(text: &str, robot_toml: &str) -> bool {
    let is_known = |line: &str| {
        let is_added = is_measured(line) || line.is_empty() || line.starts_with('[');
        is_added || robot_toml.lines().any(|old_line| old_line == line)
    };
    text.lines().any(is_measured) && text.lines().all(is_known)
}

/// True for a line with the measured numbers that its comment states, as in `x = 1.5 # measured: 1.5 +- 0.2, was 1.0`
/// and `x = [0.0, 1.5] # measured: [1] 1.5 +- 0.2, was 1.0`. A number that was measured by hand is not in the comment.
fn is_measured(line: &str) -> bool {
    let Some((key, comment)) = line.split_once(" # measured: ") else {
        return false;
    };
    let value = key.split('#').next().unwrap_or_default();
    let words = value.split(|c: char| c.is_whitespace() || "=,[]{}".contains(c));
    let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
    let is_in_line = |result: &str| {
        let number = result.split_once(" +- ").map(|(number, _)| number);
        let number = number.and_then(|number| number.rsplit(' ').next()?.parse().ok());
        number.is_some_and(|number| numbers.contains(&number))
    };
    comment == "by hand" || comment.split("; ").all(is_in_line)
}

/// Returns robot.toml with the measured values of the keys that do not agree, each with a comment. All other bytes stay
/// unchanged.
///
/// # Errors
/// Fails if robot.toml has no place for a key.
pub(super) fn with_measured_keys(
    robot_toml: &str,
    keys: &[MeasuredKey],
) -> Result<String, KeyError> {
    let mut robot_toml = robot_toml.to_owned();
    for key in keys.iter().filter(|key| !key.agrees) {
        let name = format!("{}.{}", key.table, key.name);
        let decimals = key.decimals;
        let [value, error, old_value] = key.file_values();
        let rounded: f64 = format!("{value:.decimals$}").parse().unwrap_or(value);
        robot_toml = with_number(&robot_toml, &name, rounded)?;
        let comment =
            format!("{value:.decimals$} +- {error:.decimals$}, was {old_value:.decimals$}");
        robot_toml = with_comment(&robot_toml, &name, "measured:", &comment)?;
    }
    Ok(robot_toml)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_unedited_output_is_an_earlier_output() {
        let robot_toml = "[links]\nl0 = 60.0\n[servo]\n# volts = 4.8\n";
        for (line, is_unedited) in [
            ("play = 1.25 # measured: 1.25 +- 0.02, was 1.5", true),
            ("play = 12.0 # measured: 12 +- 20, was 1.5", true),
            (
                "play = -1.5 # deg, 2 # measured: -1.50 +- 0.02, was 1.5",
                true,
            ),
            (
                "centre = [2.0, 0.0] # measured: [0] 2.0 +- 0.3, was 1.0",
                true,
            ),
            (
                "c = [2.0, 3.1] # measured: [0] 2.0 +- 0.3, was 1.0; [1] 3.1 +- 0.4, was 0.0",
                true,
            ),
            (
                "A1 = { us_per_degree = -9.8 } # measured: -9.80 +- 0.05, was 10.00",
                true,
            ),
            ("volts = 4.5 # measured: by hand", true),
            ("play = 1.3 # measured: 1.25 +- 0.02, was 1.5", false),
            ("play = 1.3 # 1.25 # measured: 1.25 +- 0.02, was 1.5", false),
            (
                "c = [2.0, 3.2] # measured: [0] 2.0 +- 0.3, was 1.0; [1] 3.1 +- 0.4, was 0.0",
                false,
            ),
            ("play = 1.25 # measured: with a ruler", false),
            ("play = 1.25", false),
        ] {
            let text = format!("{robot_toml}\n[leg.drive]\n{line}\n");
            assert_eq!(is_earlier_output(&text, robot_toml), is_unedited, "{line}");
        }
        assert!(
            !is_earlier_output(robot_toml, robot_toml),
            "it is the input"
        );
    }
}
