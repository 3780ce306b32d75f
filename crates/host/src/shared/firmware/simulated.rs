//! The firmware for a simulated UNO.

use std::path::Path;

use lizard_core::numbers::section::{REGION_BYTES, START_ADDRESS};
use lizard_robot::Robot;
use lizard_upload::{find_robot, format_robot_label};
use simulated_uno::{Image, LoadError};

use super::CODE_HEX;
use crate::shared::files::record_input;
use crate::{Failure, RobotArgs};

/// An image to run, and the name of its source.
#[derive(Debug, Clone)]
pub struct Firmware {
    /// The file's path, or a description of this program's own image.
    pub name: String,
    /// The code followed by the robot.
    pub image: Image,
}

/// Reads the image in an ELF or HEX file.
///
/// # Errors
/// Fails if the file cannot be read, or is not a program for an AVR.
pub fn read_image(path: &Path) -> Result<Image, Failure> {
    Image::read(record_input(path)).map_err(|error| load_failure(path, &error))
}

/// Returns the failure for a file that cannot be read, or is not a program for an AVR.
fn load_failure(path: &Path, error: &LoadError) -> Failure {
    let problem = describe_load_error(path, error);
    Failure::Input(format!("{problem}; `make firmware` builds the firmware"))
}

/// Describes why a file cannot be loaded; the description names the file.
pub(crate) fn describe_load_error(path: &Path, error: &LoadError) -> String {
    match error {
        // This message already names the file.
        LoadError::Read { .. } => error.to_string(),
        _ => format!("{}: {error}", path.display()),
    }
}

/// Returns the firmware for a robot: the file `elf`, which must contain this robot, or the built-in code followed by
/// this robot. `robot_args` is the robot's source.
///
/// An image without a robot's section is accepted, because a simulated UNO can run any program.
///
/// # Errors
/// Fails if the file is missing, is not a program for an AVR, or contains another robot.
pub(crate) fn select_firmware(
    elf: Option<&Path>,
    robot_args: &RobotArgs,
    robot: &Robot,
) -> Result<Firmware, Failure> {
    let Some(elf) = elf else {
        let name = format!("the firmware of lizard {}", env!("CARGO_PKG_VERSION"));
        let image = built_in_image(robot);
        return Ok(Firmware { name, image });
    };
    let name = elf.display().to_string();
    if !elf.is_file() {
        return Err(Failure::Input(format!(
            "there is no file {name}; omit --elf to run the built-in firmware"
        )));
    }
    let image = read_image(elf)?;
    let advice = "; omit --elf to run the built-in firmware with any robot";
    check_robot(&image, &name, robot_args, robot, advice)?;
    Ok(Firmware { name, image })
}

/// Checks that the image of the file `name` contains this robot or no robot. `advice` is the end of the message.
///
/// # Errors
/// Fails if the image contains another robot.
pub(crate) fn check_robot(
    image: &Image,
    name: &str,
    robot_args: &RobotArgs,
    robot: &Robot,
    advice: &str,
) -> Result<(), Failure> {
    if let Some(robot_in_image) = find_robot(&image.flash())
        && robot_in_image.hash() != robot.firmware().hash()
    {
        return Err(Failure::Input(format!(
            "{name} contains the robot {}, expected {}, which is {}{advice}",
            format_robot_label(&robot_in_image),
            robot_args.name()?,
            format_robot_label(robot.firmware())
        )));
    }
    Ok(())
}

/// Counts the bytes of code in an image with this robot, without the erased flash up to the section.
pub(crate) fn count_code_bytes(image: &Image, robot: &Robot) -> u32 {
    let code_end = image
        .symbol("__code_end")
        .map(|code_end| code_end.address as u32);
    // A HEX file has no symbols. If it leaves out the erased flash, all bytes before the section are code.
    code_end.unwrap_or_else(|| image.flash_used() - robot.section().len() as u32)
}

/// Returns the built-in code followed by this robot.
///
/// # Panics
/// Never: a test parses this code, and the image has room for a robot's section.
pub fn built_in_image(robot: &Robot) -> Image {
    let mut image = Image::parse_hex(CODE_HEX).expect("the built-in code is valid Intel HEX");
    replace_robot(&mut image, robot).expect("the image has room for a section");
    image
}

/// Replaces the robot's routines in the image by routines that do not wait for contacts; see
/// [`Robot::without_contacts`].
///
/// # Panics
/// Never: the new section is as long as the old section.
pub(crate) fn remove_contacts(mut image: Image, robot: &Robot) -> Image {
    replace_robot(&mut image, &robot.without_contacts()).expect("the image has room for a section");
    image
}

/// Reads the image in an ELF or HEX file and replaces its robot by `robot`. An image without a robot stays unchanged.
///
/// # Errors
/// Fails if the file cannot be read, or is not a program for an AVR.
pub fn read_with_robot(path: &Path, robot: &Robot) -> Result<Image, Failure> {
    let mut image = read_image(path)?;
    if find_robot(&image.flash()).is_some() {
        replace_robot(&mut image, robot).map_err(|error| load_failure(path, &error))?;
    }
    Ok(image)
}

/// Replaces the robot's section in an image.
fn replace_robot(image: &mut Image, robot: &Robot) -> Result<(), LoadError> {
    let start = u32::from(START_ADDRESS);
    image.replace(start..start + u32::from(REGION_BYTES), &robot.section())
}
