//! Measured keys of robot.toml beside the file's own values, as a table and as lines for that file.

use std::fmt::Write as _;

use lizard_film::Figure;
use lizard_measure::{MAX_AGREEING_ERRORS, verdict};
use lizard_robot::edit::{NoSuchKey, with_comment, with_number};
use serde::Serialize;

/// A measured key of robot.toml.
#[derive(Serialize)]
pub(super) struct MeasuredKey {
    /// The key's table in robot.toml, such as `servo.A1`.
    table: String,
    /// The key's name in its table.
    key: &'static str,
    measured: f64,
    /// The standard error of `measured`.
    error: f64,
    /// The value of robot.toml, converted to the supply voltage of the measurement.
    robot: f64,
    /// The measured value minus that of robot.toml, in standard errors.
    differs: f64,
    /// True if the two values differ by no more than the measurement's error explains.
    agrees: bool,
    /// Number of decimals with which the values are printed.
    #[serde(skip)]
    decimals: usize,
    /// The ratio of the value in robot.toml to `robot`.
    #[serde(skip)]
    scale: f64,
}

impl MeasuredKey {
    pub(super) fn new(
        table: &str,
        key: &'static str,
        decimals: usize,
        figure: Figure,
        robot: f64,
    ) -> Self {
        let differs = (figure.value - robot) / figure.error.max(1e-9);
        Self {
            table: table.to_owned(),
            key,
            measured: figure.value,
            error: figure.error,
            robot,
            differs,
            agrees: differs.abs() <= MAX_AGREEING_ERRORS,
            decimals,
            scale: 1.0,
        }
    }

    /// Sets the ratio of the key's value in robot.toml to its value at the supply voltage of the measurement.
    pub(super) fn with_scale(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// The key's name.
    pub(super) fn name(&self) -> &str {
        self.key
    }
}

/// The measured keys as a text table for the user.
pub(super) fn table_text(keys: &[MeasuredKey]) -> String {
    let mut text = format!("{:<28}measured   error  robot.toml\n", "");
    for key in keys {
        let verdict = verdict(key.differs);
        let decimals = key.decimals;
        let _ = writeln!(
            text,
            "{:<28}{:>8.decimals$}{:>8.decimals$}{:>12.decimals$}   {verdict}",
            key.key, key.measured, key.error, key.robot
        );
    }
    text
}

/// The measured keys as lines for robot.toml.
pub(super) fn toml_lines(keys: &[MeasuredKey]) -> String {
    let mut text = String::new();
    let mut table = "";
    for key in keys {
        if key.table != table {
            table = &key.table;
            let _ = writeln!(text, "[{table}]");
        }
        let decimals = key.decimals;
        let _ = writeln!(
            text,
            "{} = {:.decimals$} # measured, to {:.decimals$}; it was {:.decimals$}",
            key.key, key.measured, key.error, key.robot
        );
    }
    text
}

/// Returns the text of robot.toml with the measured values of the keys that do not agree, each with a comment. The rest
/// of the text stays as it is, byte for byte.
///
/// # Errors
/// Fails if the text has no place for a key.
pub(super) fn with_measured_keys(text: &str, keys: &[MeasuredKey]) -> Result<String, NoSuchKey> {
    let mut text = text.to_owned();
    for key in keys.iter().filter(|key| !key.agrees) {
        let name = format!("{}.{}", key.table, key.key);
        let ([value, error, old], decimals) = (
            [key.measured, key.error, key.robot].map(|value| value * key.scale),
            key.decimals,
        );
        let rounded: f64 = format!("{value:.decimals$}").parse().unwrap_or(value);
        text = with_number(&text, &name, rounded)?;
        let comment = format!("{value:.decimals$} +- {error:.decimals$}, was {old:.decimals$}");
        text = with_comment(&text, &name, "measured:", &comment)?;
    }
    Ok(text)
}
