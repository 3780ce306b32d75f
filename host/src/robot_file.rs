//! Which robot a subcommand is about.

use std::path::PathBuf;

use lizard_robot::Robot;

use crate::Failure;

/// The robot.toml of this source tree, for use outside of it.
const BUILT_IN: &str = include_str!("../../robot.toml");

/// `--robot`.
#[derive(clap::Args, Debug, Default)]
pub struct RobotFile {
    /// The robot's measurements and limits [default: robot.toml in this folder
    /// or one above it, else the one this program was built with]
    #[arg(long = "robot", value_name = "FILE", help_heading = "Robot")]
    path: Option<PathBuf>,
}

impl RobotFile {
    /// The one at a path, or else as [`RobotFile::load`] finds it.
    #[must_use]
    pub fn at(path: Option<PathBuf>) -> Self {
        Self { path }
    }

    /// Reads and checks the robot.
    ///
    /// # Errors
    /// The file is missing or wrong.
    pub fn load(&self) -> Result<Robot, Failure> {
        if let Some(path) = &self.path {
            return Ok(Robot::load(path)?);
        }
        let here = std::env::current_dir()?;
        let found = here
            .ancestors()
            .map(|folder| folder.join("robot.toml"))
            .find(|path| path.is_file());
        Ok(match found {
            Some(path) => Robot::load(path)?,
            None => Robot::parse(BUILT_IN)?,
        })
    }
}
