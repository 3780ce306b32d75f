//! The firmware for a simulated UNO.

use std::path::{Path, PathBuf};

use lizard_core::numbers::section::{SPACE_BYTES, START_ADDRESS};
use lizard_robot::Robot;
use lizard_upload::{robot_in, robot_label};
use simulated_uno::{Image, LoadError};

use super::CODE_HEX;
use crate::shared::files::note_input;
use crate::{Failure, RobotFile};

/// An image to run, and the name of its source.
#[derive(Debug, Clone)]
pub struct Firmware {
    /// The file's path, or a description of this program's own image.
    pub name: String,
    /// The code followed by the robot.
    pub image: Image,
}

/// The error for a file that cannot be read, or is not a program for an AVR.
#[derive(Debug, thiserror::Error)]
#[error("{}: {error}; `make firmware` builds the firmware", path.display())]
pub struct ReadError {
    path: PathBuf,
    error: LoadError,
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        Self::Input(error.to_string())
    }
}

/// Reads the program of an ELF or HEX file.
///
/// # Errors
/// Fails if the file cannot be read, or is not a program for an AVR.
pub fn read_image(path: &Path) -> Result<Image, ReadError> {
    Image::read(note_input(path)).map_err(|error| ReadError {
        path: path.to_owned(),
        error,
    })
}

/// The reason why an image cannot be run.
#[derive(Debug, thiserror::Error)]
enum FirmwareError {
    #[error("there is no firmware at {0}; without --elf, the one inside this program is used")]
    Missing(String),
    #[error(
        "{} has the robot {elf_robot} in it, and not {robot}, which is {robot_label}; without \
         --elf, the firmware inside this program runs with any robot",
        elf.display()
    )]
    OtherRobot {
        elf: PathBuf,
        robot: String,
        elf_robot: String,
        robot_label: String,
    },
}

impl From<FirmwareError> for Failure {
    fn from(error: FirmwareError) -> Self {
        Self::Input(error.to_string())
    }
}

/// Returns the firmware to run for a robot: the given file, which must contain this robot, or the code inside this
/// program followed by this robot. `robot_file` is the robot's source.
///
/// An image without a robot's section is accepted, because a simulated UNO can run any program.
///
/// # Errors
/// Fails if the file is missing, is not a program for an AVR, or contains another robot.
pub(crate) fn select_firmware(
    elf: Option<&Path>,
    robot_file: &RobotFile,
    robot: &Robot,
) -> Result<Firmware, Failure> {
    let Some(elf) = elf else {
        let name = format!("the firmware of lizard {}", env!("CARGO_PKG_VERSION"));
        let image = built_in_image(robot);
        return Ok(Firmware { name, image });
    };
    if !elf.is_file() {
        return Err(FirmwareError::Missing(elf.display().to_string()).into());
    }
    let image = read_image(elf)?;
    if let Some(robot_in_image) = robot_in(&image.flash())
        && robot_in_image.hash() != robot.firmware().hash()
    {
        return Err(FirmwareError::OtherRobot {
            robot: robot_file.name()?,
            elf_robot: robot_label(&robot_in_image),
            robot_label: robot_label(robot.firmware()),
            elf: elf.to_owned(),
        }
        .into());
    }
    let name = elf.display().to_string();
    Ok(Firmware { name, image })
}

/// Size of the code in an image with this robot, bytes, without the erased flash up to the section.
pub(crate) fn code_bytes(image: &Image, robot: &Robot) -> u32 {
    let code_end = image
        .symbol("__code_end")
        .map(|code_end| code_end.address as u32);
    // A HEX file has no symbols. If it leaves out the erased flash, all bytes before the section are code.
    code_end.unwrap_or_else(|| image.flash_used() - robot.section().len() as u32)
}

/// The code inside this program followed by this robot.
///
/// # Panics
/// Never: a test parses this code, and the image has room for a robot's section.
pub fn built_in_image(robot: &Robot) -> Image {
    let mut image = Image::parse_hex(CODE_HEX).expect("the built-in code is valid Intel HEX");
    replace_robot(&mut image, robot).expect("the image has room for a section");
    image
}

/// Changes this robot's routines in the image so that they do not wait for contacts; see
/// [`Robot::without_contacts`].
///
/// # Panics
/// Never: the new section is as long as the old section.
pub(crate) fn without_contacts(mut image: Image, robot: &Robot) -> Image {
    replace_robot(&mut image, &robot.without_contacts()).expect("the image has room for a section");
    image
}

/// Reads the program of an ELF or HEX file and replaces the file's robot by this robot. A program without a robot
/// stays unchanged.
///
/// # Errors
/// Fails if the file cannot be read, or is not a program for an AVR.
pub fn read_with_robot(path: &Path, robot: &Robot) -> Result<Image, ReadError> {
    let mut image = read_image(path)?;
    if robot_in(&image.flash()).is_some() {
        replace_robot(&mut image, robot).map_err(|error| ReadError {
            path: path.to_owned(),
            error,
        })?;
    }
    Ok(image)
}

/// Replaces the robot's section of an image.
fn replace_robot(image: &mut Image, robot: &Robot) -> Result<(), LoadError> {
    let start = u32::from(START_ADDRESS);
    image.replace(start..start + u32::from(SPACE_BYTES), &robot.section())
}
