//! Which firmware a command runs on the simulated UNO, and with which robot.
//!
//! The firmware is one image for any lizard; its robot is a section of flash behind the
//! code. So a command takes whatever image there is and puts the robot that it was told
//! into it. If a user names an image that has another robot in it, one of the two is
//! not what was meant, and it is not run.

use std::path::{Path, PathBuf};

use lizard_core::robot::Robot as CoreRobot;
use lizard_core::section::{Region, SPACE, START};
use lizard_robot::Robot;
use simulated_uno::{Image, LoadError};

use crate::board::BoardError;
use crate::{Failure, RobotFile};

/// The code of the firmware in Intel HEX, up to where the robot's section begins.
///
/// `make code-image` writes the file anew, and a test compares it with what the source builds.
pub const CODE: &str = include_str!("../../firmware/code.hex");

/// Where `make firmware` leaves it.
const BUILT: &str = "target/avr-atmega328p/release/lizard.elf";

/// Why an image is not run.
#[derive(Debug, thiserror::Error)]
enum FirmwareError {
    #[error("there is no firmware at {0}; build it with `make firmware`")]
    Missing(String),
    #[error(
        "{} has the robot {its} in it, and not {robot}, which is {wanted}; without --elf, the \
         program that `make firmware` has built runs with any robot",
        elf.display()
    )]
    OtherRobot {
        elf: PathBuf,
        robot: String,
        its: String,
        wanted: String,
    },
}

impl From<FirmwareError> for Failure {
    fn from(error: FirmwareError) -> Self {
        Self::Input(error.to_string())
    }
}

/// The firmware to run for a robot: the file given, which must have this robot in it, or
/// what `make firmware` leaves in this folder or one above it, with this robot put into it;
/// and that file. `file` is where the robot was read from.
///
/// An image that has no robot's section is no lizard's and is let through: what it does is
/// seen when it runs.
///
/// # Errors
/// There is none, it is no program of an AVR, or it has another robot in it.
pub(crate) fn of_robot(
    elf: Option<&Path>,
    file: &RobotFile,
    robot: &Robot,
) -> Result<(PathBuf, Image), Failure> {
    let path = find(elf)?;
    let load = |error| BoardError::Load {
        elf: path.clone(),
        error,
    };
    if elf.is_some() {
        let image = Image::read(&path).map_err(load)?;
        let flash = image.flash();
        if let Some(its) = robot_in(&flash)
            && its.hash() != robot.firmware().hash()
        {
            return Err(FirmwareError::OtherRobot {
                robot: file.name()?,
                its: named(&its),
                wanted: named(robot.firmware()),
                elf: path,
            }
            .into());
        }
    }
    let image = with_robot(&path, robot).map_err(load)?;
    Ok((path, image))
}

/// The program of an ELF or HEX file with this robot in place of the one that it has;
/// as it is where it has none.
///
/// # Errors
/// It cannot be read, or is no program of an AVR.
pub fn with_robot(path: &Path, robot: &Robot) -> Result<Image, LoadError> {
    let mut image = Image::read(path)?;
    if robot_in(&image.flash()).is_some() {
        let start = u32::from(START);
        image.replace(start..start + u32::from(SPACE), &robot.section())?;
    }
    Ok(image)
}

/// The robot in a flash.
fn robot_in(flash: &[u8]) -> Option<CoreRobot<'_>> {
    CoreRobot::open(Region::new(flash.get(usize::from(START)..)?)).ok()
}

/// A robot's name and hash, as its banner says them.
#[must_use]
pub fn named(robot: &CoreRobot) -> String {
    let name: String = robot.label().map(char::from).collect();
    format!("{name} {:08x}", robot.hash())
}

fn find(given: Option<&Path>) -> Result<PathBuf, Failure> {
    let missing = |path: &Path| FirmwareError::Missing(path.display().to_string()).into();
    if let Some(path) = given {
        return if path.is_file() {
            Ok(path.to_owned())
        } else {
            Err(missing(path))
        };
    }
    let here = crate::robot_file::here()?;
    let mut folders = here.ancestors().map(|folder| folder.join(BUILT));
    folders
        .find(|path| path.is_file())
        .ok_or_else(|| missing(Path::new(BUILT)))
}
