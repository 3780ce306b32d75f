//! Measured values beside those of robot.toml, as a table and as lines for that file.

use std::fmt::Write as _;

use lizard_film::Figure;
use lizard_measure::{MAX_AGREEING_ERRORS, verdict};
use lizard_robot::edit::{NoSuchKey, with_comment, with_number};
use serde::Serialize;

/// A measured key of robot.toml.
#[derive(Serialize)]
pub(super) struct Key {
    /// The key's table, such as `servo.A1`; `key` is its name.
    table: String,
    key: &'static str,
    measured: f64,
    error: f64,
    /// The value by robot.toml, for the same supply.
    robot: f64,
    /// The measured value minus that of robot.toml, in standard errors.
    differs: f64,
    agrees: bool,
    #[serde(skip)]
    decimals: usize,
    /// The value in robot.toml divided by that for the supply of the measurement.
    #[serde(skip)]
    scale: f64,
}

impl Key {
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

    /// Sets the ratio of the key's value in robot.toml to its value for the supply of the measurement.
    pub(super) fn scaled(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// The key's name.
    pub(super) fn name(&self) -> &str {
        self.key
    }
}

/// The table of measured values.
pub(super) fn table(keys: &[Key]) -> String {
    let mut text = format!("{:<28}measured   error  robot.toml\n", "");
    for key in keys {
        let verdict = verdict(key.differs);
        let digits = key.decimals;
        let _ = writeln!(
            text,
            "{:<28}{:>8.digits$}{:>8.digits$}{:>12.digits$}   {verdict}",
            key.key, key.measured, key.error, key.robot
        );
    }
    text
}

/// The measured keys as lines for robot.toml.
pub(super) fn toml_lines(keys: &[Key]) -> String {
    let mut text = String::new();
    let mut table = "";
    for key in keys {
        if key.table != table {
            table = &key.table;
            let _ = writeln!(text, "[{table}]");
        }
        let digits = key.decimals;
        let _ = writeln!(
            text,
            "{} = {:.digits$} # measured, to {:.digits$}; it was {:.digits$}",
            key.key, key.measured, key.error, key.robot
        );
    }
    text
}

/// Returns the text of robot.toml in which the keys that differ from their measurement are replaced, each with a
/// comment; the rest stays as it is, byte for byte.
///
/// # Errors
/// Fails if the text has no place for a key.
pub(super) fn with_measured_keys(text: &str, keys: &[Key]) -> Result<String, NoSuchKey> {
    let mut text = text.to_owned();
    for key in keys.iter().filter(|key| !key.agrees) {
        let name = format!("{}.{}", key.table, key.key);
        let ([value, error, old], digits) = (
            [key.measured, key.error, key.robot].map(|figure| figure * key.scale),
            key.decimals,
        );
        let rounded: f64 = format!("{value:.digits$}").parse().unwrap_or(value);
        text = with_number(&text, &name, rounded)?;
        let comment = format!("{value:.digits$} +- {error:.digits$}, was {old:.digits$}");
        text = with_comment(&text, &name, "measured:", &comment)?;
    }
    Ok(text)
}
