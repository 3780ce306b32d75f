//! The calibration of one robot, which `save` stores: as lines of the console, and as a file.
//!
//! Two robots built from one robot.toml differ in the teeth on which the horns sit and in the servos themselves. The
//! host program and the page measure these differences and store them; the rules for both are here.

use std::collections::VecDeque;

use lizard_core::console::command::MAX_DEADMAN_MS;
use toml::de::DeTable;

use crate::file::{Checked, Error, Fault, Section, parse};
use crate::measures::servo::NAMES;

/// The value of the key `format`. The number rises when a key changes its meaning.
const FORMAT: &str = "lizard calibration 1";
const HEADER: &str = "\
# A lizard's calibration. `lizard calibrate restore` gives it back to the robot.
# Angles in degrees; trim and limit as the console has them, scale in us per degree.

";
/// Tolerance for equal numbers: slightly less than half of the last digit that the console prints, 0.01.
const TOLERANCE: f64 = 0.0049;

/// The settings of a robot.
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
    /// The settings of a servo that turns in the opposite direction. The horn stays where it is: the same pulse is
    /// the opposite trim.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self {
            dir: if self.dir == '+' { '-' } else { '+' },
            trim: 0.0 - self.trim,
            ..self
        }
    }

    /// The settings with another scale, us/deg. The horn stays where it is: the trim is converted to the new degrees.
    #[must_use]
    pub fn with_scale(self, scale: f64) -> Self {
        let scale = round_to_hundredths(scale);
        Self {
            trim: round_to_hundredths(self.trim * self.scale / scale),
            scale,
            ..self
        }
    }

    /// Reads a servo's line in the answer to `cal`, such as `# A1 trim 0 limit 48.59 228.59 dir + scale 10`, given
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

    fn read(section: &Section) -> Checked<Self> {
        let read_number = |key| {
            let value = section.number(key, -360.0, 360.0, "deg")?;
            require_two_decimals(section, key, value)
        };
        let limit: [f64; 2] = section.numbers("limit", -360.0, 360.0, "deg")?;
        for end in limit {
            require_two_decimals(section, "limit", end)?;
        }
        let dir = match section.text("dir")? {
            "+" => '+',
            "-" => '-',
            direction => {
                let problem = format!("is \"{direction}\"; it must be \"+\" or \"-\"");
                return Err(section.fault("dir", problem));
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
    /// Reads the answer to `cal`; skips other lines. `None` if a setting is missing or cannot be read.
    #[must_use]
    pub fn from_lines(lines: &[String]) -> Option<Self> {
        let rest_after = |word: &str| {
            let mut rests = lines.iter().filter_map(|line| {
                let rest = line.strip_prefix("# ")?.strip_prefix(word)?;
                rest.strip_prefix(' ')
            });
            rests.next()
        };
        let servos: Option<Vec<_>> = NAMES
            .iter()
            .map(|name| ServoSettings::parse(rest_after(name)?))
            .collect();
        Some(Self {
            boot: rest_after("boot").filter(|boot| is_name(boot))?.to_owned(),
            deadman: rest_after("deadman")?.parse().ok()?,
            servos: servos?.try_into().ok()?,
        })
    }

    /// The console's lines that set all these settings.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
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

    /// True if a robot would print the same settings for both calibrations; limits may differ by full turns.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        let is_near = |a: f64, b: f64| (a - b).abs() < TOLERANCE;
        let is_same_angle = |a: f64, b: f64| {
            let turn = (a - b).rem_euclid(360.0);
            turn.min(360.0 - turn) < TOLERANCE
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

    /// The text of the calibration file: TOML, so that a person can read and change it.
    #[must_use]
    pub fn text(&self) -> String {
        let Self { boot, deadman, .. } = self;
        let mut text =
            format!("{HEADER}format = \"{FORMAT}\"\nboot = \"{boot}\"\ndeadman = {deadman}\n");
        for (name, servo) in NAMES.iter().zip(&self.servos) {
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

    /// Reads the text of a calibration file; errors give the file's `name`.
    ///
    /// # Errors
    /// Returns the first mistake, with its line and key.
    pub fn parse(text: &str, name: &str) -> Result<Self, Error> {
        parse(text, Self::read).map_err(|error| Error {
            file: name.to_owned(),
            ..error
        })
    }

    fn read(table: &DeTable) -> Checked<Self> {
        let format = table.get("format").map(|value| value.get_ref().as_str());
        if format != Some(Some(FORMAT)) {
            let problem = format!("must be \"{FORMAT}\": this is no calibration that can be read");
            return Err(Fault::new("format", problem));
        }
        let root = Section::root(table, &["format", "boot", "deadman", "servo"])?;
        let boot = root.text("boot")?;
        if !is_name(boot) {
            return Err(root.fault("boot", "is not the name of a gait"));
        }
        let deadman = root.number("deadman", 0.0, f64::from(MAX_DEADMAN_MS), "ms")?;
        if deadman.fract() != 0.0 {
            return Err(root.fault("deadman", "must be a whole number of ms"));
        }
        let servos = root.section("servo", &NAMES)?;
        let read_servo = |name| {
            let keys = ["trim", "limit", "dir", "scale"];
            ServoSettings::read(&servos.section(name, &keys)?)
        };
        let [a1, a2, a3, a4] = NAMES;
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

/// The lines that give a robot a calibration, unsaved, in an order that it accepts.
///
/// The robot refuses a line after which a gait would leave the servos' travel. While the settings change one by one,
/// that may happen although both calibrations are valid. So refused lines are sent again after the others, as long as
/// each round has fewer of them. Then all lines are sent once more after `factory`, which sets robot.toml's values.
#[derive(Clone, Debug)]
pub struct Transfer {
    all: Vec<String>,
    /// The lines of the current round that have not been sent yet.
    unsent_lines: VecDeque<String>,
    last: String,
    refused: Vec<String>,
    /// Number of lines of the current round.
    round: usize,
    is_from_factory: bool,
}

impl Transfer {
    /// Makes a transfer that has sent no line yet.
    #[must_use]
    pub fn new(calibration: &Calibration) -> Self {
        let lines = calibration.lines();
        Self {
            unsent_lines: lines.clone().into(),
            last: String::new(),
            refused: Vec::new(),
            round: lines.len(),
            is_from_factory: false,
            all: lines,
        }
    }

    /// The next line to send; `None` if no line is left, or if no line of a round after `factory` was accepted.
    pub fn next_line(&mut self) -> Option<String> {
        if self.unsent_lines.is_empty() && !self.refused.is_empty() {
            if self.refused.len() < self.round {
                self.unsent_lines = std::mem::take(&mut self.refused).into();
            } else if !self.is_from_factory {
                self.is_from_factory = true;
                self.refused.clear();
                self.unsent_lines = self.all.clone().into();
                self.unsent_lines.push_front("factory".to_owned());
            }
            self.round = self.unsent_lines.len();
        }
        self.last = self.unsent_lines.pop_front()?;
        Some(self.last.clone())
    }

    /// Records that the robot has refused the last line. Returns true for the first refusal of the current round.
    pub fn refuse(&mut self) -> bool {
        self.refused.push(std::mem::take(&mut self.last));
        self.refused.len() == 1
    }

    /// True if all lines are sent and none of them is still refused.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.unsent_lines.is_empty() && self.refused.is_empty()
    }
}

/// True if a text has the form of a gait's name and may be sent to the robot unchanged.
fn is_name(text: &str) -> bool {
    let is_allowed = |c: char| c.is_ascii_alphanumeric() || c == ' ' || c == '-' || c == '_';
    !text.is_empty() && text.len() <= 48 && text.chars().all(is_allowed)
}

/// Returns a number that has at most two decimals, and refuses any other number: the console accepts no more.
fn require_two_decimals(section: &Section, key: &str, value: f64) -> Checked<f64> {
    match (value * 100.0 - (value * 100.0).round()).abs() < 1e-6 {
        true => Ok(value),
        false => Err(section.fault(
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
