//! Measured figures beside those of robot.toml, as a table and as lines for that file.

use std::fmt::Write as _;

use lizard_film::Figure;
use lizard_measure::{AGREES, verdict};
use serde::Serialize;

/// A measured key of robot.toml.
#[derive(Serialize)]
pub(super) struct Key {
    /// Its table, as `servo.A1`, and its name.
    table: String,
    key: &'static str,
    measured: f64,
    error: f64,
    /// By robot.toml, for the same supply.
    robot: f64,
    /// The measured one less that, in standard errors.
    differs: f64,
    agrees: bool,
    #[serde(skip)]
    decimals: usize,
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
            agrees: differs.abs() <= AGREES,
            decimals,
        }
    }

    /// The key's name.
    pub(super) fn name(&self) -> &str {
        self.key
    }
}

/// The table of figures.
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

/// The lines for robot.toml.
pub(super) fn lines(keys: &[Key]) -> String {
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
