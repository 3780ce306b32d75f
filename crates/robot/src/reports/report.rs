//! The figures of every gait: the table that `make firmware` and `lizard gaits` print.

use std::fmt;

use lizard_contact::Prediction;
use lizard_core::numbers::section::SPACE;

use crate::checks::{Audit, CheckedGait, TableError};
use crate::measures::servo::NAMES;
use crate::reports::sprung::Sprung;
use crate::robot::Robot;

/// The figures of a gait.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name of the gait.
    pub name: String,
    /// Time of a cycle at full speed, s.
    pub period: f64,
    /// Margins, strokes and the fastest frame.
    pub audit: Audit,
    /// Error of its tables over all 65 536 phases.
    pub error: TableError,
    /// Movement of one cycle by the contact model.
    pub way: Prediction,
    /// Effect of the legs' drive; none if legs are rigid without play.
    pub sprung: Option<Sprung>,
}

/// The figures of all gaits.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Rows of the table, in the order of the file.
    pub rows: Vec<Row>,
    /// Hash of the tables.
    pub hash: u32,
    /// Number of waveforms that the gaits share.
    pub waves: usize,
    /// Bytes of the robot's section in flash; at most [`SPACE`].
    pub flash: usize,
    /// True if a line that names a gait may make a frame late.
    pub searches_long: bool,
    /// Name of the robot.
    pub name: String,
}

/// CPU cycles that the main loop may spend on a line without making a frame late: docs/firmware.md.
const BESIDE_A_FRAME: usize = 34_000;

/// The note for a robot whose console takes longer to find a gait's name.
const SEARCHES_LONG: &str = "many gaits: `cal`, or a line that names one, may make a frame 20 ms late; \
     fewer gaits or shorter names avoid it\n";

/// The meaning of a dash in place of a prediction.
pub const UNDECIDED: &str =
    "- undecided: two feet against two, where the smallest difference between the pads decides\n";

impl Report {
    /// Measures the tables and predicts the gaits of a robot; takes a moment.
    pub fn of(robot: &Robot) -> Self {
        let row = |gait: &CheckedGait| Row {
            name: gait.name().to_string(),
            period: gait.period(),
            audit: *gait.audit(),
            error: gait.table_error(),
            way: robot.predict(gait),
            sprung: Sprung::of(gait, robot.ground()),
        };
        let firmware = robot.core();
        Self {
            rows: robot.gaits().iter().map(row).collect(),
            hash: firmware.hash(),
            waves: firmware.waves().len(),
            flash: robot.section().len(),
            searches_long: robot.longest_search() > BESIDE_A_FRAME,
            name: robot.name().to_string(),
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(
            f,
            "{} gaits in {} waveforms, {} bytes of flash of {}, robot {} {:08x}\n",
            self.rows.len(),
            self.waves,
            self.flash,
            SPACE,
            self.name,
            self.hash
        )?;
        let lags = self.rows.iter().any(|row| row.sprung.is_some());
        let width = widest(self.rows.iter().map(|row| row.name.as_str()));
        writeln!(
            f,
            "{:width$}  cycle      fastest  table error, deg      smallest margins       slider, mm    one cycle, mm and deg{}",
            "",
            if lags { "   drive, deg and %" } else { "" }
        )?;
        writeln!(
            f,
            "{:width$}      s  deg/s servo      max     rms  type-2 type-1    leg    least   most    ahead   left    turn{}",
            "gait",
            if lags { "      lag  of rigid" } else { "" }
        )?;
        for row in &self.rows {
            let Row {
                name,
                period,
                audit,
                error,
                way,
                sprung,
            } = row;
            write!(
                f,
                "{name:<width$} {period:>6.2} {:>6.1} {:>5}   {:>6.4}  {:>6.4}  {:>6.3} {:>6.3} {:>6.3}   {:>+6.1} {:>+6.1}  ",
                audit.peak.speed,
                NAMES[audit.peak.servo],
                error.max,
                error.rms,
                audit.type2.value,
                audit.type1.value,
                audit.leg.value,
                tidy(audit.stroke.0, 1),
                tidy(audit.stroke.1, 1),
            )?;
            write!(
                f,
                "{:>7} {:>6} {:>7}",
                known(way.forward, 2),
                known(way.left, 2),
                known(way.turn, 2)
            )?;
            if let Some(Sprung { lag, share, .. }) = sprung {
                let share = share.map_or("-".to_string(), |share| format!("{:.0}", 100.0 * share));
                write!(f, "   {lag:>6.2} {share:>9}")?;
            }
            writeln!(f)?;
        }
        if self.rows.iter().any(|row| !row.way.is_decided()) {
            write!(f, "\n{UNDECIDED}")?;
        }
        if self.searches_long {
            write!(f, "\n{SEARCHES_LONG}")?;
        }
        Ok(())
    }
}

/// The width of a column for these names.
pub(crate) fn widest<'a>(names: impl Iterator<Item = &'a str>) -> usize {
    names.map(str::len).fold(12, usize::max)
}

/// Formats a part of a prediction with its sign; a dash if it is undecided.
pub(crate) fn known(part: Option<f64>, decimals: usize) -> String {
    match part {
        Some(value) => format!("{:+.decimals$}", tidy(value, decimals as i32)),
        None => "-".to_string(),
    }
}

/// Rounds a value, without the sign of a zero.
fn tidy(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    // Adding positive zero turns a negative one positive.
    (value * scale).round() / scale + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::robot;

    #[test]
    fn columns_stay_in_line_whatever_the_names() {
        for name in ["paper", "own-gaits"] {
            let text = Report::of(&robot(name)).to_string();
            let rows: Vec<&str> = text
                .lines()
                .skip(2)
                .take_while(|line| !line.is_empty())
                .collect();
            let long = rows[1].len();
            assert!(
                rows.len() > 10 && rows[1..].iter().all(|row| row.len() == long),
                "{text}"
            );
        }
    }

    #[test]
    fn nothing_is_shown_as_minus_zero() {
        assert_eq!(
            [
                known(Some(-0.004), 2),
                known(Some(-0.006), 2),
                known(None, 2)
            ],
            ["+0.00", "-0.01", "-"]
        );
    }
}
