//! The firmware for a simulated UNO.

use std::path::{Path, PathBuf};

use lizard_core::numbers::section::{SPACE_BYTES, START_ADDRESS};
use lizard_robot::Robot;
use lizard_upload::{robot_in, robot_label};
use simulated_uno::{Image, LoadError};

use super::CODE;
use crate::shared::files::note_input;
use crate::{Failure, RobotFile};

/// An image to run, and its source.
#[derive(Debug, Clone)]
pub struct Firmware {
    /// The file's path, or a note that it is this program's own image.
    pub name: String,
    /// The code followed by the robot.
    pub image: Image,
}

/// The error for a file that is not a program of an AVR, or cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {error}; `make firmware` builds it", elf.display())]
pub struct Unreadable {
    elf: PathBuf,
    error: LoadError,
}

impl From<Unreadable> for Failure {
    fn from(error: Unreadable) -> Self {
        Self::Input(error.to_string())
    }
}

/// Reads the program of an ELF or HEX file.
///
/// # Errors
/// Fails if the file cannot be read, or is not a program of an AVR.
pub fn read(elf: &Path) -> Result<Image, Unreadable> {
    Image::read(note_input(elf)).map_err(|error| Unreadable {
        elf: elf.to_owned(),
        error,
    })
}

/// The reason why an image is not run.
#[derive(Debug, thiserror::Error)]
enum FirmwareError {
    #[error("there is no firmware at {0}; without --elf, the one inside this program is used")]
    Missing(String),
    #[error(
        "{} has the robot {its} in it, and not {robot}, which is {wanted}; without --elf, the \
         firmware inside this program runs with any robot",
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

/// The firmware to run for a robot: the given file, which must contain this robot, or the code inside this program
/// followed by this robot. `robot_file` is the robot's source.
///
/// An image without a robot's section is another program and is accepted: running it shows what it does.
///
/// # Errors
/// Fails if the file is missing, is not a program of an AVR, or has another robot in it.
pub(crate) fn select_firmware(
    elf: Option<&Path>,
    robot_file: &RobotFile,
    robot: &Robot,
) -> Result<Firmware, Failure> {
    let Some(elf) = elf else {
        let name = format!("the firmware of lizard {}", env!("CARGO_PKG_VERSION"));
        let image = image_with(robot);
        return Ok(Firmware { name, image });
    };
    if !elf.is_file() {
        return Err(FirmwareError::Missing(elf.display().to_string()).into());
    }
    let image = read(elf)?;
    if let Some(robot_in_image) = robot_in(&image.flash())
        && robot_in_image.hash() != robot.firmware().hash()
    {
        return Err(FirmwareError::OtherRobot {
            robot: robot_file.name()?,
            its: robot_label(&robot_in_image),
            wanted: robot_label(robot.firmware()),
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
/// Never: a test reads that code, and a robot's section has room.
pub fn image_with(robot: &Robot) -> Image {
    let mut image = Image::parse_hex(CODE).expect("a test reads it");
    put_robot(&mut image, robot).expect("a robot's section has room");
    image
}

/// The image with this robot, whose routines do not wait for contacts: see [`Robot::without_contacts`].
///
/// # Panics
/// Never: the section is as long as that of the robot.
pub(crate) fn without_contacts(mut image: Image, robot: &Robot) -> Image {
    put_robot(&mut image, &robot.without_contacts()).expect("a robot's section has room");
    image
}

/// The program of an ELF or HEX file with this robot in place of the file's robot. A program
/// without a robot stays unchanged.
///
/// # Errors
/// Fails if the file cannot be read, or is not a program of an AVR.
pub fn with_robot(path: &Path, robot: &Robot) -> Result<Image, Unreadable> {
    let mut image = read(path)?;
    if robot_in(&image.flash()).is_some() {
        put_robot(&mut image, robot).map_err(|error| Unreadable {
            elf: path.to_owned(),
            error,
        })?;
    }
    Ok(image)
}

/// Replaces the robot's section of an image.
fn put_robot(image: &mut Image, robot: &Robot) -> Result<(), LoadError> {
    let start = u32::from(START_ADDRESS);
    image.replace(start..start + u32::from(SPACE_BYTES), &robot.section())
}
