//! Which robot a subcommand is about.

use std::path::{Path, PathBuf};

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
        Ok(match self.found()? {
            Some(path) => Robot::load(path)?,
            None => Robot::parse(BUILT_IN)?,
        })
    }

    /// The file that was named with `--robot`.
    #[must_use]
    pub fn given(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// What the user is told where the robot is from.
    ///
    /// # Errors
    /// This folder has no name any more.
    pub fn name(&self) -> Result<String, Failure> {
        Ok(match self.found()? {
            Some(path) => path.display().to_string(),
            None => "the robot.toml that this program was built with".to_owned(),
        })
    }

    /// The file that is read; none for the one that is built in.
    fn found(&self) -> Result<Option<PathBuf>, Failure> {
        if let Some(path) = &self.path {
            return Ok(Some(path.clone()));
        }
        let here = here()?;
        let mut above = here.ancestors().map(|folder| folder.join("robot.toml"));
        Ok(above.find(|path| path.is_file()))
    }
}

/// This folder.
///
/// # Errors
/// It was removed, or may not be read.
pub(crate) fn here() -> Result<PathBuf, Failure> {
    std::env::current_dir()
        .map_err(|error| Failure::Impossible(format!("this folder has no path: {error}")))
}
