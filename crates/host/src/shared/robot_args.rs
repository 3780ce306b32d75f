//! The robot that a command uses.

use std::path::PathBuf;
use std::sync::OnceLock;

use lizard_robot::{CheckedGait, Robot};

use crate::Failure;
use crate::shared::files::record_input;
use crate::shared::suggestion::format_suggestion;

/// The text of the source tree's robot.toml, the default if no robot.toml is found.
pub(crate) const DEFAULT_ROBOT_TOML: &str = include_str!("../../../../robot.toml");

/// The robots in robots/, with their names.
const BUILT_IN_ROBOTS: [(&str, &str); 5] = [
    ("grain", include_str!("../../../../robots/grain.toml")),
    ("large", include_str!("../../../../robots/large.toml")),
    (
        "own-gaits",
        include_str!("../../../../robots/own-gaits.toml"),
    ),
    ("paper", include_str!("../../../../robots/paper.toml")),
    ("unequal", include_str!("../../../../robots/unequal.toml")),
];

/// Returns the names of the built-in robots.
pub(crate) fn built_in_names() -> [&'static str; BUILT_IN_ROBOTS.len()] {
    BUILT_IN_ROBOTS.map(|(name, _)| name)
}

/// Returns a robot in robots/, for tests.
#[cfg(test)]
pub fn built_in_robot(name: &str) -> Robot {
    let entry = BUILT_IN_ROBOTS
        .iter()
        .find(|(known_name, _)| *known_name == name);
    Robot::parse(entry.expect(name).1).expect("robots/ holds valid robots")
}

/// The option `--robot`.
#[derive(clap::Args, Debug, Default)]
pub struct RobotArgs {
    /// A robot file, or the name of a built-in robot: grain, large, own-gaits, paper, unequal
    /// [default: robot.toml in this folder or the nearest folder above it, else the built-in
    /// robot.toml]
    #[arg(long = "robot", value_name = "FILE", help_heading = "Robot")]
    path: Option<PathBuf>,
    /// The text given to [`RobotArgs::from_text`]; it replaces the search for a robot file.
    #[arg(skip)]
    text: Option<String>,
    /// The text that was read, because a pipe can be read only once.
    #[arg(skip)]
    read_text: OnceLock<String>,
}

impl RobotArgs {
    /// Selects the robot with this text.
    pub(crate) fn from_text(text: String) -> Self {
        Self {
            text: Some(text),
            ..Self::default()
        }
    }

    /// Returns the text of the robot file.
    ///
    /// # Errors
    /// Fails if the file is missing or is not valid UTF-8, if `--robot` is a mistyped name, or if the current folder
    /// cannot be determined.
    pub(crate) fn text(&self) -> Result<&str, Failure> {
        if let Some(text) = self.read_text.get() {
            return Ok(text);
        }
        let text = match self.find_source()? {
            RobotSource::File(path) => Robot::read_text(record_input(&path))?,
            RobotSource::Text(text) => text.to_owned(),
        };
        Ok(self.read_text.get_or_init(|| text))
    }

    /// Selects the robot in the file at this path. With `None`, [`RobotArgs::load`] searches for robot.toml.
    pub fn from_path(path: Option<PathBuf>) -> Self {
        Self {
            path,
            ..Self::default()
        }
    }

    /// Reads and checks the robot.
    ///
    /// # Errors
    /// Fails if the file is missing or invalid, if `--robot` is a mistyped name, or if the current folder cannot be
    /// determined.
    pub fn load(&self) -> Result<Robot, Failure> {
        let robot = Robot::parse(self.text()?);
        Ok(robot.map_err(|error| match self.find_source() {
            Ok(RobotSource::File(path)) => error.in_file(&path),
            _ => error,
        })?)
    }

    /// Returns the name of the robot's source, for messages; not for a text from `from_text`.
    ///
    /// # Errors
    /// Fails if `--robot` is a mistyped name, or if the current folder cannot be determined.
    pub fn name(&self) -> Result<String, Failure> {
        Ok(match (self.find_source()?, &self.path) {
            (RobotSource::File(path), _) => path.display().to_string(),
            (RobotSource::Text(_), Some(name)) => format!("the robot {}", name.display()),
            (RobotSource::Text(_), None) => "the built-in robot.toml".to_owned(),
        })
    }

    /// Finds the robot's source: the text of `from_text`, or else the robot of `--robot`, where a file takes precedence
    /// over a built-in robot with the same name. Without `--robot`, looks for robot.toml in the current folder and the
    /// folders above it.
    fn find_source(&self) -> Result<RobotSource<'_>, Failure> {
        if let Some(text) = &self.text {
            return Ok(RobotSource::Text(text));
        }
        if let Some(path) = &self.path {
            let built_in = BUILT_IN_ROBOTS
                .iter()
                .find(|(name, _)| path.as_os_str() == *name);
            let name = path.display().to_string();
            let suggestion = format_suggestion(&name, built_in_names());
            return match built_in {
                // `lizard parts large --robot large` makes a folder with the robot's name.
                Some((_, text)) if path.is_dir() => Ok(RobotSource::Text(text)),
                _ if path.exists() => Ok(RobotSource::File(path.clone())),
                Some((_, text)) => Ok(RobotSource::Text(text)),
                None if suggestion.is_empty() => Ok(RobotSource::File(path.clone())),
                None => Err(Failure::Input(format!(
                    "{name} is neither a file nor a built-in robot{suggestion}"
                ))),
            };
        }
        let folder = std::env::current_dir().map_err(|error| {
            Failure::Operation(format!("cannot determine the current folder: {error}"))
        })?;
        let mut candidates = folder.ancestors().map(|folder| folder.join("robot.toml"));
        // A broken link is an error, and not a reason to take another robot.
        let file = candidates.find(|path| path.is_file() || path.is_symlink());
        Ok(file.map_or(RobotSource::Text(DEFAULT_ROBOT_TOML), RobotSource::File))
    }
}

/// The source of a robot.
enum RobotSource<'a> {
    /// A file at this path.
    File(PathBuf),
    /// The robot's text, for example of a built-in robot.
    Text(&'a str),
}

/// Finds the gait called `name`.
///
/// # Errors
/// Fails if the robot has no such gait, or if the gait moves no servo.
pub(crate) fn find_moving_gait<'a>(
    robot: &'a Robot,
    name: &str,
) -> Result<&'a CheckedGait, Failure> {
    match robot.gait(name) {
        Some(gait) if gait.has_movement() => Ok(gait),
        Some(_) => Err(Failure::Input(format!("the gait `{name}` moves no servo"))),
        None => {
            let problem = format!("the robot has no gait `{name}`");
            let moving_gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
            Err(unknown_gait_failure(&problem, name, moving_gaits))
        }
    }
}

/// Returns the failure for an unknown gait: the problem, the allowed names, and the allowed name most similar to
/// `name`. Without allowed gaits, the message says that no gait moves a servo.
pub(crate) fn unknown_gait_failure<'a>(
    problem: &str,
    name: &str,
    allowed_gaits: impl Iterator<Item = &'a CheckedGait>,
) -> Failure {
    let names: Vec<&str> = allowed_gaits.map(CheckedGait::name).collect();
    if names.is_empty() {
        return Failure::Input(format!("{problem}; no gait of the robot moves a servo"));
    }
    let list = names.join(", ");
    let suggestion = format_suggestion(name, names);
    Failure::Input(format!("{problem}; allowed values: {list}{suggestion}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_without_moving_gaits_has_no_list_of_allowed_gaits() {
        let failure = unknown_gait_failure("unknown gait", "walk", std::iter::empty());
        let message = "unknown gait; no gait of the robot moves a servo";
        assert_eq!(failure.to_string(), message);
    }

    #[test]
    fn every_file_in_robots_is_built_in_under_its_name() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots");
        let entries = std::fs::read_dir(folder).expect("robots/ is readable");
        let mut names: Vec<_> = entries
            .map(|entry| entry.expect("robots/ is readable").path())
            .map(|path| path.file_stem().expect("the file has a name").to_owned())
            .collect();
        names.sort();
        assert_eq!(names, BUILT_IN_ROBOTS.map(|(name, _)| name));
        for (name, text) in BUILT_IN_ROBOTS {
            let args = RobotArgs::from_path(Some(name.into()));
            assert!(args.load().is_ok(), "{name}");
            assert_eq!(args.text().expect("a built-in robot has a text"), text);
            assert_eq!(
                args.name().expect("a built-in robot has a name"),
                format!("the robot {name}")
            );
        }
        let result = RobotArgs::from_path(Some("papre".into())).load();
        let message = "papre is neither a file nor a built-in robot; did you mean `paper`?";
        assert!(result.is_err_and(|error| error.to_string() == message));
    }
}
