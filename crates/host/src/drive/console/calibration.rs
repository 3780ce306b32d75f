//! The settings that `save` stores, in the form in which the console prints and accepts them.

use std::io::{Read, Write};

use serde::{Deserialize, Serialize};

use super::link::{Link, LinkError};

/// The settings of a robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// The action after power-on: a gait, or rest.
    pub boot: String,
    /// Milliseconds without a line after which a gait ends; 0 for never.
    pub deadman: u16,
    /// The settings of all four servos.
    pub servo: Servos,
}

/// The four servos.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the servos' names")]
pub struct Servos {
    #[serde(rename = "A1")]
    pub a1: Servo,
    #[serde(rename = "A2")]
    pub a2: Servo,
    #[serde(rename = "A3")]
    pub a3: Servo,
    #[serde(rename = "A4")]
    pub a4: Servo,
}

/// The settings of one servo.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Servo {
    /// The trim: the counter-clockwise turn that the horn needs, degrees.
    pub trim: f64,
    /// The travel's ends, degrees in the chassis frame.
    pub limit: [f64; 2],
    /// The direction in which a longer pulse turns the servo.
    pub dir: Direction,
    /// Microseconds of pulse for a degree.
    pub scale: f64,
}

/// The sense of turning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Direction {
    /// A longer pulse turns counter-clockwise.
    #[serde(rename = "+")]
    Plus,
    /// A longer pulse turns clockwise.
    #[serde(rename = "-")]
    Minus,
}

impl Direction {
    /// The sign as the console writes it.
    pub const fn sign(self) -> char {
        match self {
            Self::Plus => '+',
            Self::Minus => '-',
        }
    }

    /// The opposite direction.
    #[must_use]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Plus => Self::Minus,
            Self::Minus => Self::Plus,
        }
    }
}

impl Servos {
    /// A1 to A4.
    pub fn all(&self) -> [&Servo; 4] {
        [&self.a1, &self.a2, &self.a3, &self.a4]
    }

    /// A servo by its index, 0 to 3.
    pub fn at(&mut self, index: usize) -> &mut Servo {
        match index {
            0 => &mut self.a1,
            1 => &mut self.a2,
            2 => &mut self.a3,
            _ => &mut self.a4,
        }
    }
}

impl Calibration {
    /// Asks a robot for its settings.
    ///
    /// # Errors
    /// Fails if there is no answer, or one that is not understood.
    pub fn ask<P: Read + Write>(link: &mut Link<P>) -> Result<Self, LinkError> {
        let reply = link.command("cal")?;
        Self::parse(&reply.notes).ok_or_else(|| LinkError::Unclear {
            line: "cal".to_owned(),
            answer: reply.notes.join(" / "),
        })
    }

    /// Reads the lines of `cal`; other `#` lines among them are skipped.
    fn parse(lines: &[String]) -> Option<Self> {
        let value_of = |key: &str| lines.iter().find_map(|line| line.strip_prefix(key));
        let servo = |name: &str| {
            let mut words = value_of(&format!("# {name} "))?.split(' ');
            let mut number = |word: &str| -> Option<f64> {
                (words.next()? == word).then_some(())?;
                words.next()?.parse().ok()
            };
            let trim = number("trim")?;
            let min = number("limit")?;
            let max = words.next()?.parse().ok()?;
            let dir = match (words.next()?, words.next()?) {
                ("dir", "+") => Direction::Plus,
                ("dir", "-") => Direction::Minus,
                _ => return None,
            };
            (words.next()? == "scale").then_some(())?;
            let scale = words.next()?.parse().ok()?;
            let limit = [min, max];
            Some(Servo {
                trim,
                limit,
                dir,
                scale,
            })
        };
        Some(Self {
            boot: value_of("# boot ").filter(|boot| is_name(boot))?.to_owned(),
            deadman: value_of("# deadman ")?.parse().ok()?,
            servo: Servos {
                a1: servo("A1")?,
                a2: servo("A2")?,
                a3: servo("A3")?,
                a4: servo("A4")?,
            },
        })
    }

    /// The console commands that set all values.
    pub fn commands(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for (index, servo) in self.servo.all().into_iter().enumerate() {
            let n = index + 1;
            let [min, max] = servo.limit;
            lines.push(format!("dir {n} {}", servo.dir.sign()));
            lines.push(format!("scale {n} {:.2}", servo.scale));
            lines.push(format!("trim {n} {:.2}", servo.trim));
            lines.push(format!("limit {n} {min:.2} {max:.2}"));
        }
        lines.push(format!("boot {}", self.boot));
        lines.push(format!("deadman {}", self.deadman));
        lines
    }

    /// Gives a robot these settings, unsaved. The robot refuses a command after which a
    /// gait would leave the servos' travel. On the way from one calibration to another
    /// that may happen although the result is valid. So a refused command is tried
    /// again after the others, and once more from robot.toml's settings.
    ///
    /// # Errors
    /// Returns the first refusal of those that remain; the robot then has a part of the settings.
    pub fn apply<P: Read + Write>(&self, link: &mut Link<P>) -> Result<(), LinkError> {
        let mut lines = self.commands();
        let mut from_factory = false;
        loop {
            let mut refusal = None;
            let mut left = Vec::new();
            for line in &lines {
                match link.command(line) {
                    Ok(_) => {}
                    Err(error @ LinkError::Refused { .. }) => {
                        refusal = refusal.or(Some(error));
                        left.push(line.clone());
                    }
                    Err(error) => return Err(error),
                }
            }
            let Some(refusal) = refusal else {
                return Ok(());
            };
            if left.len() < lines.len() {
                lines = left;
            } else if from_factory {
                return Err(refusal);
            } else {
                from_factory = true;
                link.command("factory")?;
                lines = self.commands();
            }
        }
    }

    /// True if a robot would print the same for both: angles are the same modulo a turn.
    pub fn is_same(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() < 0.0049;
        let is_same_angle = |a: f64, b: f64| {
            let turn = (a - b).rem_euclid(360.0);
            turn.min(360.0 - turn) < 0.0049
        };
        let servos = self.servo.all().into_iter().zip(other.servo.all());
        self.boot == other.boot
            && self.deadman == other.deadman
            && servos.into_iter().all(|(a, b)| {
                near(a.trim, b.trim)
                    && near(a.scale, b.scale)
                    && a.dir == b.dir
                    && is_same_angle(a.limit[0], b.limit[0])
                    && is_same_angle(a.limit[1], b.limit[1])
            })
    }
}

/// True if a text may be the name of a gait, which is sent to the robot unchanged.
pub(super) fn is_name(text: &str) -> bool {
    let letters = |c: char| c.is_ascii_alphanumeric() || c == ' ' || c == '-' || c == '_';
    !text.is_empty() && text.len() <= 48 && text.chars().all(letters)
}

#[cfg(test)]
mod tests {
    use super::super::double::{PAPER, robot, robot_of};
    use super::*;

    /// The calibration that the simulated robot starts with.
    fn factory() -> Calibration {
        Calibration::ask(&mut robot()).expect("it answers")
    }

    #[test]
    fn the_settings_of_a_new_robot_are_those_of_robot_toml() {
        let calibration = factory();
        assert_eq!(calibration.boot, "stand");
        assert_eq!(calibration.deadman, 0);
        for (servo, neutral) in calibration
            .servo
            .all()
            .into_iter()
            .zip([138.59, 41.41, 318.59, 221.41])
        {
            assert_eq!(
                (servo.trim, servo.dir, servo.scale),
                (0.0, Direction::Plus, 10.0)
            );
            let min = (neutral - 90.0_f64).rem_euclid(360.0);
            assert!((servo.limit[0] - min).abs() < 0.011, "{servo:?}");
        }
    }

    #[test]
    fn settings_that_were_sent_are_read_back() {
        let mut link = robot();
        let mut calibration = factory();
        calibration.servo.at(1).trim = -3.25;
        calibration.servo.at(2).dir = Direction::Minus;
        calibration.servo.at(3).scale = 10.57;
        calibration.servo.at(0).limit = [70.0, -150.0];
        calibration.boot = "arc left".to_owned();
        calibration.deadman = 1500;
        calibration.apply(&mut link).expect("it takes them");
        let read_back = Calibration::ask(&mut link).expect("it answers");
        assert!(calibration.is_same(&read_back), "{read_back:?}");
        assert!(!calibration.is_same(&factory()));
    }

    #[test]
    fn a_setting_that_the_current_ones_forbid_is_retried_after_the_others() {
        // With 400 us either way a large trim and a large scale exclude each other.
        let narrow = PAPER.replace("min_us = 600.0", "min_us = 1100.0");
        let narrow = narrow.replace("max_us = 2400.0", "max_us = 1900.0");
        let mut link = robot_of(&narrow);
        let first = Calibration::ask(&mut link).expect("it answers");
        let [mut scaled, mut trimmed] = [first.clone(), first];
        scaled.servo.at(0).scale = 16.0;
        trimmed.servo.at(0).trim = 15.0;
        for calibration in [&trimmed, &scaled, &trimmed] {
            calibration.apply(&mut link).expect("it takes them");
            let read_back = Calibration::ask(&mut link).expect("it answers");
            assert!(calibration.is_same(&read_back), "{read_back:?}");
        }
    }

    #[test]
    fn two_calibrations_that_differ_in_anything_are_not_the_same() {
        let changes: [fn(&mut Calibration); 6] = [
            |calibration| calibration.servo.a1.trim = 0.01,
            |calibration| calibration.servo.a2.limit[1] += 0.01,
            |calibration| calibration.servo.a3.dir = Direction::Minus,
            |calibration| calibration.servo.a4.scale = 10.01,
            |calibration| calibration.boot = "walk".to_owned(),
            |calibration| calibration.deadman = 1,
        ];
        for (n, change) in changes.into_iter().enumerate() {
            let mut calibration = factory();
            change(&mut calibration);
            assert!(!calibration.is_same(&factory()), "change {n}");
        }
    }

    #[test]
    fn settings_that_do_not_suit_the_gaits_are_refused_with_the_robots_reason() {
        let mut link = robot();
        let mut calibration = factory();
        calibration.servo.at(1).limit = [40.0, 43.0];
        let error = calibration.apply(&mut link).expect_err("too narrow");
        let words = error.to_string();
        assert!(
            words.contains("`limit 2 40.00 43.00`: 3 A2 would"),
            "{words}"
        );
    }
}
