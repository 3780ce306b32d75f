//! The calibration of one robot (the settings that the console command `save` stores), its two forms (console lines and
//! a TOML file), and its transfer to the robot.
//!
//! Two robots built from the same robot.toml differ in their servos and in the spline tooth on which each horn is
//! mounted. The host program and the page measure and store these differences; both use this module.

use std::collections::VecDeque;

use lizard_core::console::command::MAX_DEADMAN_MS;
use lizard_core::numbers::gaits::MAX_NAME_BYTES;
use toml::de::DeTable;

use crate::config::servo::SERVO_NAMES;
use crate::file::{Error, ReadResult, Table, parse, read_for_each};

/// The value of the key `format`. The number is incremented when the meaning of a key changes.
const FORMAT_VERSION: &str = "lizard calibration 1";
/// The comment at the start of a calibration file.
const FILE_HEADER: &str = "\
# A lizard's calibration. `lizard calibrate restore` sends it to the robot again.
# Angles in degrees, counter-clockwise positive; limit in the chassis frame; scale in us per degree.

";
/// Largest difference between settings that count as equal: slightly less than half of 0.01, the last digit that the
/// console prints.
const TOLERANCE: f64 = 0.0049;

/// The settings of a robot that `save` stores.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Calibration {
    /// The gait that starts after power-on, or `rest`.
    pub boot: String,
    /// Time without a line after which a gait ends, ms; 0 for never.
    pub deadman: u16,
    /// The servos A1 to A4.
    pub servos: [ServoSettings; 4],
}

/// The settings of one servo.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ServoSettings {
    /// Correction of the horn's angle, deg, counter-clockwise positive.
    pub trim: f64,
    /// Smallest and largest angle of the travel, deg, chassis frame.
    pub limit: [f64; 2],
    /// The direction in which a longer pulse turns the servo: `+` for counter-clockwise, or `-`.
    pub dir: char,
    /// Change in pulse width per degree, us.
    pub scale: f64,
}

impl ServoSettings {
    /// Returns the settings of a servo that turns in the opposite direction. The neutral pulse width stays the same, so
    /// the trim's sign changes.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self {
            dir: if self.dir == '+' { '-' } else { '+' },
            // Not `-self.trim`, which would be -0.0 for a trim of 0.
            trim: 0.0 - self.trim,
            ..self
        }
    }

    /// Returns the settings with another scale, us/deg. The neutral pulse width stays the same, because the trim is
    /// converted to the new scale.
    #[must_use]
    pub fn with_scale(self, scale: f64) -> Self {
        let scale = round_to_hundredths(scale);
        Self {
            trim: round_to_hundredths(self.trim * self.scale / scale),
            scale,
            ..self
        }
    }

    /// Parses a servo's line in the answer to `cal`, such as `# A1 trim 0 limit 48.59 228.59 dir + scale 10`, without
    /// the leading `# A1 `. `None` if a setting is missing or invalid.
    fn parse(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split(' ').collect();
        let [
            "trim",
            trim,
            "limit",
            min,
            max,
            "dir",
            dir @ ("+" | "-"),
            "scale",
            scale,
            ..,
        ] = words[..]
        else {
            return None;
        };
        Some(Self {
            trim: trim.parse().ok()?,
            limit: [min.parse().ok()?, max.parse().ok()?],
            dir: dir.chars().next()?,
            scale: scale.parse().ok()?,
        })
    }

    /// Reads the table of a servo in a calibration file.
    fn from_table(table: &Table) -> ReadResult<Self> {
        let read_number = |key, unit| {
            let value = table.number(key, (-360.0, 360.0), unit)?;
            require_two_decimals(table, key, value)
        };
        let limit: [f64; 2] = table.numbers("limit", (-360.0, 360.0), "deg")?;
        for angle in limit {
            require_two_decimals(table, "limit", angle)?;
        }
        let dir = match table.text("dir")? {
            "+" => '+',
            "-" => '-',
            direction => {
                let problem = format!("is \"{direction}\"; it must be \"+\" or \"-\"");
                return Err(table.error("dir", problem));
            }
        };
        Ok(Self {
            trim: read_number("trim", "deg")?,
            limit,
            dir,
            scale: read_number("scale", "us per deg")?,
        })
    }
}

impl Calibration {
    /// Parses the answer to `cal`; skips other lines. `None` if a setting is missing or invalid.
    #[must_use]
    pub fn from_cal_answer(lines: &[String]) -> Option<Self> {
        let text_after = |keyword: &str| {
            lines.iter().find_map(|line| {
                let line_text = line.strip_prefix("# ")?.strip_prefix(keyword)?;
                line_text.strip_prefix(' ')
            })
        };
        let servos: Option<Vec<_>> = SERVO_NAMES
            .iter()
            .map(|name| ServoSettings::parse(text_after(name)?))
            .collect();
        Some(Self {
            boot: text_after("boot")
                .filter(|boot| is_gait_name(boot))?
                .to_owned(),
            deadman: text_after("deadman")?.parse().ok()?,
            servos: servos?.try_into().ok()?,
        })
    }

    /// Returns the console lines that set all these settings.
    #[must_use]
    pub fn to_console_lines(&self) -> Vec<String> {
        let servos = self.servos.iter().zip(1..).flat_map(|(servo, number)| {
            let [min, max] = servo.limit;
            [
                format!("dir {number} {}", servo.dir),
                format!("scale {number} {:.2}", servo.scale),
                format!("trim {number} {:.2}", servo.trim),
                format!("limit {number} {min:.2} {max:.2}"),
            ]
        });
        let general_lines = [
            format!("boot {}", self.boot),
            format!("deadman {}", self.deadman),
        ];
        servos.chain(general_lines).collect()
    }

    /// True if a robot would print the same settings for both calibrations, except for full turns in the limits.
    #[must_use]
    pub fn is_equivalent_to(&self, other: &Self) -> bool {
        let is_equal = |a: f64, b: f64| (a - b).abs() < TOLERANCE;
        let is_same_angle = |a: f64, b: f64| {
            let difference = (a - b).rem_euclid(360.0);
            difference.min(360.0 - difference) < TOLERANCE
        };
        let mut servos = self.servos.iter().zip(&other.servos);
        self.boot == other.boot
            && self.deadman == other.deadman
            && servos.all(|(a, b)| {
                is_equal(a.trim, b.trim)
                    && is_equal(a.scale, b.scale)
                    && a.dir == b.dir
                    && is_same_angle(a.limit[0], b.limit[0])
                    && is_same_angle(a.limit[1], b.limit[1])
            })
    }

    /// Returns the text of the calibration file in TOML, which a person can read and edit.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let Self { boot, deadman, .. } = self;
        let mut text = format!(
            "{FILE_HEADER}format = \"{FORMAT_VERSION}\"\nboot = \"{boot}\"\ndeadman = {deadman}\n"
        );
        for (name, servo) in SERVO_NAMES.iter().zip(&self.servos) {
            let ServoSettings {
                trim,
                limit,
                dir,
                scale,
            } = servo;
            text += &format!(
                "\n[servo.{name}]\ntrim = {trim:?}\nlimit = {limit:?}\ndir = \"{dir}\"\nscale = {scale:?}\n"
            );
        }
        text
    }

    /// Parses the text of a calibration file; errors name the file as `file_name`.
    ///
    /// # Errors
    /// Returns the first error, with its line and key.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, Error> {
        parse(text, Self::from_document).map_err(|error| Error {
            file: file_name.to_owned(),
            ..error
        })
    }

    /// Reads the tables of a calibration file.
    fn from_document(document: &DeTable) -> ReadResult<Self> {
        let format = document.get("format").map(|value| value.get_ref().as_str());
        if format != Some(Some(FORMAT_VERSION)) {
            let problem = format!(
                "must be \"{FORMAT_VERSION}\": this is not a calibration file of a supported version"
            );
            return Err(Error::new("format", problem));
        }
        let root = Table::root(document, &["format", "boot", "deadman", "servo"])?;
        let boot = root.text("boot")?;
        if !is_gait_name(boot) {
            return Err(root.error(
                "boot",
                "must be the name of a gait or a routine, or \"rest\"",
            ));
        }
        let deadman = root.number("deadman", (0.0, f64::from(MAX_DEADMAN_MS)), "ms")?;
        if deadman.fract() != 0.0 {
            return Err(root.error("deadman", "must be a whole number of ms"));
        }
        let servos = root.table("servo", &SERVO_NAMES)?;
        Ok(Self {
            boot: boot.to_owned(),
            deadman: deadman as u16,
            servos: read_for_each(SERVO_NAMES, |name| {
                let keys = ["trim", "limit", "dir", "scale"];
                ServoSettings::from_table(&servos.table(name, &keys)?)
            })?,
        })
    }
}

/// A transfer of a calibration to a robot, line by line, in an order that the robot accepts. The transfer does not save
/// the calibration.
///
/// The robot refuses a line after which a gait would leave the servos' travel. This may happen while the settings
/// change one by one, even if the old and the new calibration are both valid. Refused lines are therefore sent again
/// after the other lines, as long as their number falls from round to round. If lines are refused even then, all lines
/// are sent once more after `factory`, which sets robot.toml's values.
#[derive(Clone, Debug)]
pub struct Transfer {
    /// The lines for all settings.
    all_lines: Vec<String>,
    /// The lines of the current round that have not been sent yet.
    unsent_lines: VecDeque<String>,
    /// The line that was sent last.
    last_line: String,
    /// The refused lines of the current round.
    refused_lines: Vec<String>,
    /// Number of lines in the current round.
    round_line_count: usize,
    /// True once the round that starts with `factory` has begun.
    has_begun_factory_round: bool,
}

impl Transfer {
    /// Creates a transfer that has not sent a line yet.
    #[must_use]
    pub fn new(calibration: &Calibration) -> Self {
        let lines = calibration.to_console_lines();
        Self {
            unsent_lines: lines.clone().into(),
            last_line: String::new(),
            refused_lines: Vec::new(),
            round_line_count: lines.len(),
            has_begun_factory_round: false,
            all_lines: lines,
        }
    }

    /// Returns the next line to send; `None` if no line is left, or if the robot refused every line of a round after
    /// `factory`.
    pub fn next_line(&mut self) -> Option<String> {
        if self.unsent_lines.is_empty() && !self.refused_lines.is_empty() {
            if self.refused_lines.len() < self.round_line_count {
                self.unsent_lines = std::mem::take(&mut self.refused_lines).into();
            } else if !self.has_begun_factory_round {
                self.has_begun_factory_round = true;
                self.refused_lines.clear();
                self.unsent_lines = self.all_lines.clone().into();
                self.unsent_lines.push_front("factory".to_owned());
            }
            self.round_line_count = self.unsent_lines.len();
        }
        self.last_line = self.unsent_lines.pop_front()?;
        Some(self.last_line.clone())
    }

    /// Records that the robot refused the last line. Returns true if this is the round's first refusal, whose reason
    /// the caller reports.
    pub fn record_refusal(&mut self) -> bool {
        self.refused_lines.push(std::mem::take(&mut self.last_line));
        self.refused_lines.len() == 1
    }

    /// True if all lines have been sent and accepted.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.unsent_lines.is_empty() && self.refused_lines.is_empty()
    }
}

/// True if a text has the form of a gait name and may be sent to the robot unchanged.
fn is_gait_name(text: &str) -> bool {
    let is_allowed = |c: char| c.is_ascii_alphanumeric() || c == ' ' || c == '-' || c == '_';
    !text.is_empty() && text.len() <= MAX_NAME_BYTES && text.chars().all(is_allowed)
}

/// Returns the value if it has at most two decimals, which is the most that the console accepts; otherwise an error.
fn require_two_decimals(table: &Table, key: &str, value: f64) -> ReadResult<f64> {
    match (value * 100.0 - (value * 100.0).round()).abs() < 1e-6 {
        true => Ok(value),
        false => Err(table.error(
            key,
            format!("is {value}; it must have at most two decimals"),
        )),
    }
}

/// Rounds to hundredths, as the robot does, without a negative zero.
#[must_use]
pub fn round_to_hundredths(value: f64) -> f64 {
    (value * 100.0).round() / 100.0 + 0.0
}

#[cfg(test)]
mod tests;
