//! The sources of an image: a file, or the built-in firmware.

use std::path::Path;

use lizard_robot::Robot;
use lizard_upload::{Image, ImageError};

use crate::Failure;
use crate::shared::files;
use crate::shared::firmware::CODE_HEX;

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Self {
        Self::Input(error.to_string())
    }
}

/// Builds a robot's image: the built-in code, followed by this robot's section of numbers; with `only_robot`, the
/// section alone.
///
/// # Errors
/// Never fails for a valid robot; a test builds the images of each robot in robots/.
pub fn build_image(robot: &Robot, only_robot: bool) -> Result<Image, ImageError> {
    if only_robot {
        Image::robot_alone(robot.section())
    } else {
        Image::firmware(CODE_HEX, &robot.section())
    }
}

/// Reads an image from an Intel HEX file.
///
/// # Errors
/// Fails if the file cannot be read, or is not an image for a UNO.
pub fn read_hex_image(path: &Path) -> Result<Image, Failure> {
    let name = path.display();
    let text = files::read_text(path)?;
    Image::from_hex(&text).map_err(|error| Failure::Input(format!("{name}: {error}")))
}

#[cfg(test)]
mod tests {
    use lizard_core::numbers::mark::Mark;
    use lizard_core::numbers::section::START_ADDRESS;
    use lizard_upload::BLANK;

    use super::*;

    #[test]
    fn images_of_all_robots_contain_their_section_with_and_without_the_code() {
        let code = Image::from_hex(CODE_HEX).expect("the code is Intel HEX");
        let code = code.bytes();
        assert_eq!(Mark::read(code), Some(Mark::THIS_FIRMWARE));
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots");
        let mut robot_count = 0;
        for file in std::fs::read_dir(folder).expect("the folder robots/ is readable") {
            let path = file.expect("the folder is readable").path();
            let robot = Robot::load(&path).expect("the robot.toml is valid");
            let image = build_image(&robot, false).expect("the image fits the flash");
            let (code_area, section) = image.bytes().split_at(START_ADDRESS.into());
            let (code_in_image, gap) = code_area.split_at(code.len());
            assert!(code_in_image == code, "{}", path.display());
            assert!(gap.iter().all(|byte| *byte == BLANK));
            assert!(section == robot.section(), "{}", path.display());
            let robot_image = build_image(&robot, true).expect("the image fits the flash");
            assert!(robot_image.bytes() == section);
            assert_eq!(robot_image.end_address(), image.end_address());
            robot_count += 1;
        }
        assert!(robot_count >= 4, "{robot_count} robots");
    }

    #[test]
    fn the_error_names_a_file_that_is_not_an_image() {
        let file = tempfile::NamedTempFile::new().expect("a temporary file can be created");
        std::fs::write(file.path(), "[servo]\n").expect("the file can be written");
        let failure = read_hex_image(file.path()).expect_err("a TOML file must be refused");
        let name = file.path().display();
        let expected = format!("{name}: line 1 is not Intel HEX: missing start code ':'");
        assert_eq!(failure.to_string(), expected);
    }
}
