//! The calibration of one robot, which the console command `save` stores, as console lines and as a file.
//!
//! Two robots built from one robot.toml differ in the teeth on which the horns sit and in the servos themselves. The
//! host program and the page measure these differences and store them, both by the rules of this module.

use std::collections::VecDeque;

use lizard_core::console::command::MAX_DEADMAN_MS;
use toml::de::DeTable;

use crate::file::{Checked, Error, Section, UnlocatedError, parse};
use crate::measures::servo::SERVO_NAMES;

/// The value of the key `format`. Its number increases when a key changes its meaning.
const FORMAT: &str = "lizard calibration 1";
/// The comment at the start of a calibration file.
const FILE_HEADER: &str = "\
# A lizard's calibration. `lizard calibrate restore` gives it back to the robot.
# Angles in degrees; trim and limit as the console has them, scale in us per degree.

";
/// Largest difference between settings that count as equal: slightly less than half of 0.01, the last digit that the
/// console prints.
const TOLERANCE: f64 = 0.0049;

/// The settings of a robot that `save` stores.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Calibration {
    /// The action after power-on: a gait, or rest.
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
    /// Change of the pulse's width per degree, us.
    pub scale: f64,
}

impl ServoSettings {
    /// Returns the settings of a servo that turns in the opposite direction. The neutral pulse width stays the same,
    /// so the trim changes its sign.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self {
            dir: if self.dir == '+' { '-' } else { '+' },
            trim: 0.0 - self.trim,
            ..self
        }
    }

    /// Returns the settings with another scale, us/deg. The neutral pulse width stays the same: the trim is
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

    /// Parses a servo's line in the answer to `cal`, such as `# A1 trim 0 limit 48.59 228.59 dir + scale 10`, given
    /// without `# A1 `. `None` if a setting is missing or cannot be read.
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
    fn from_section(section: &Section) -> Checked<Self> {
        let read_number = |key| {
            let value = section.number(key, -360.0, 360.0, "deg")?;
            require_two_decimals(section, key, value)
        };
        let limit: [f64; 2] = section.numbers("limit", -360.0, 360.0, "deg")?;
        for angle in limit {
            require_two_decimals(section, "limit", angle)?;
        }
        let dir = match section.text("dir")? {
            "+" => '+',
            "-" => '-',
            direction => {
                let problem = format!("is \"{direction}\"; it must be \"+\" or \"-\"");
                return Err(section.error("dir", problem));
            }
        };
        Ok(Self {
            trim: read_number("trim")?,
            limit,
            dir,
            scale: read_number("scale")?,
        })
    }
}

impl Calibration {
    /// Parses the answer to `cal`; skips other lines. `None` if a setting is missing or cannot be read.
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
    pub fn console_lines(&self) -> Vec<String> {
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

    /// True if a robot would print the same settings for both calibrations, apart from full turns in the limits.
    #[must_use]
    pub fn is_equivalent_to(&self, other: &Self) -> bool {
        let is_near = |a: f64, b: f64| (a - b).abs() < TOLERANCE;
        let is_same_angle = |a: f64, b: f64| {
            let difference = (a - b).rem_euclid(360.0);
            difference.min(360.0 - difference) < TOLERANCE
        };
        let mut servos = self.servos.iter().zip(&other.servos);
        self.boot == other.boot
            && self.deadman == other.deadman
            && servos.all(|(a, b)| {
                is_near(a.trim, b.trim)
                    && is_near(a.scale, b.scale)
                    && a.dir == b.dir
                    && is_same_angle(a.limit[0], b.limit[0])
                    && is_same_angle(a.limit[1], b.limit[1])
            })
    }

    /// Returns the text of the calibration file: TOML, so that a person can read and change it.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let Self { boot, deadman, .. } = self;
        let mut text =
            format!("{FILE_HEADER}format = \"{FORMAT}\"\nboot = \"{boot}\"\ndeadman = {deadman}\n");
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

    /// Parses the text of a calibration file; errors give the file's `name`.
    ///
    /// # Errors
    /// Returns the first mistake, with its line and key.
    pub fn parse(text: &str, name: &str) -> Result<Self, Error> {
        parse(text, Self::from_table).map_err(|error| Error {
            file: name.to_owned(),
            ..error
        })
    }

    /// Reads the tables of a calibration file.
    fn from_table(table: &DeTable) -> Checked<Self> {
        let format = table.get("format").map(|value| value.get_ref().as_str());
        if format != Some(Some(FORMAT)) {
            let problem =
                format!("must be \"{FORMAT}\": this is not a calibration that can be read");
            return Err(UnlocatedError::new("format", problem));
        }
        let root = Section::root(table, &["format", "boot", "deadman", "servo"])?;
        let boot = root.text("boot")?;
        if !is_gait_name(boot) {
            return Err(root.error("boot", "is not the name of a gait"));
        }
        let deadman = root.number("deadman", 0.0, f64::from(MAX_DEADMAN_MS), "ms")?;
        if deadman.fract() != 0.0 {
            return Err(root.error("deadman", "must be a whole number of ms"));
        }
        let servos = root.section("servo", &SERVO_NAMES)?;
        let read_servo = |name| {
            let keys = ["trim", "limit", "dir", "scale"];
            ServoSettings::from_section(&servos.section(name, &keys)?)
        };
        let [a1, a2, a3, a4] = SERVO_NAMES;
        Ok(Self {
            boot: boot.to_owned(),
            deadman: deadman as u16,
            servos: [
                read_servo(a1)?,
                read_servo(a2)?,
                read_servo(a3)?,
                read_servo(a4)?,
            ],
        })
    }
}

/// A transfer of a calibration to a robot, line by line, in an order that the robot accepts. The transfer does not save
/// the calibration.
///
/// The robot refuses a line after which a gait would leave the servos' travel. This may happen while the settings
/// change one by one, even if the old and the new calibration are both valid. So refused lines are sent again after
/// the others, as long as each round has fewer of them. Then all lines are sent once more after `factory`, which sets
/// robot.toml's values.
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
    has_sent_factory: bool,
}

impl Transfer {
    /// Creates a transfer that has not sent a line yet.
    #[must_use]
    pub fn new(calibration: &Calibration) -> Self {
        let lines = calibration.console_lines();
        Self {
            unsent_lines: lines.clone().into(),
            last_line: String::new(),
            refused_lines: Vec::new(),
            round_line_count: lines.len(),
            has_sent_factory: false,
            all_lines: lines,
        }
    }

    /// Returns the next line to send; `None` if no line is left, or if no line of a round after `factory` was accepted.
    pub fn next_line(&mut self) -> Option<String> {
        if self.unsent_lines.is_empty() && !self.refused_lines.is_empty() {
            if self.refused_lines.len() < self.round_line_count {
                self.unsent_lines = std::mem::take(&mut self.refused_lines).into();
            } else if !self.has_sent_factory {
                self.has_sent_factory = true;
                self.refused_lines.clear();
                self.unsent_lines = self.all_lines.clone().into();
                self.unsent_lines.push_front("factory".to_owned());
            }
            self.round_line_count = self.unsent_lines.len();
        }
        self.last_line = self.unsent_lines.pop_front()?;
        Some(self.last_line.clone())
    }

    /// Records that the robot has refused the last line. Returns true if it is the first refusal of the round.
    pub fn record_refusal(&mut self) -> bool {
        self.refused_lines.push(std::mem::take(&mut self.last_line));
        self.refused_lines.len() == 1
    }

    /// True if all lines have been sent and none of them is still refused.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.unsent_lines.is_empty() && self.refused_lines.is_empty()
    }
}

/// True if a text has the form of a gait's name and may be sent to the robot unchanged.
fn is_gait_name(text: &str) -> bool {
    let is_allowed = |c: char| c.is_ascii_alphanumeric() || c == ' ' || c == '-' || c == '_';
    !text.is_empty() && text.len() <= 48 && text.chars().all(is_allowed)
}

/// Returns the value if it has at most two decimals, the most that the console accepts; refuses it otherwise.
fn require_two_decimals(section: &Section, key: &str, value: f64) -> Checked<f64> {
    match (value * 100.0 - (value * 100.0).round()).abs() < 1e-6 {
        true => Ok(value),
        false => Err(section.error(
            key,
            format!("is {value}; it must have at most two decimals"),
        )),
    }
}

/// Rounds to hundredths, as the robot does, without a negative zero.
fn round_to_hundredths(value: f64) -> f64 {
    (value * 100.0).round() / 100.0 + 0.0
}

#[cfg(test)]
mod tests;
