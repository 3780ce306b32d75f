//! The sources of an image: a file, or the firmware inside this program.

use std::path::Path;

use lizard_robot::Robot;
use lizard_upload::{Image, ImageError};

use crate::Failure;
use crate::shared::files;
use crate::shared::firmware::CODE;

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Self {
        Self::Input(error.to_string())
    }
}

/// The image of a robot: the code inside this program followed by this robot's section.
///
/// # Errors
/// Never fails for a valid robot; a test makes the image of every built-in robot.
pub fn image(robot: &Robot) -> Result<Image, ImageError> {
    Image::firmware(CODE, &robot.section())
}

/// A robot's section alone.
///
/// # Errors
/// Never fails: flash has room for any robot's section.
pub fn robot_alone(robot: &Robot) -> Result<Image, ImageError> {
    Image::robot_alone(robot.section())
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
    use lizard_core::numbers::section::START;
    use lizard_upload::BLANK;

    use super::*;

    #[test]
    fn every_robot_follows_the_same_code_or_is_alone() {
        let code = Image::from_hex(CODE).expect("it is Intel HEX");
        let code = code.bytes();
        assert_eq!(Mark::find(code), Some(Mark::OWN));
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots");
        let mut count = 0;
        for file in std::fs::read_dir(folder).expect("robots/") {
            let path = file.expect("a file").path();
            let robot = Robot::load(&path).expect("it is right");
            let image = image(&robot).expect("it fits");
            let (start, section) = image.bytes().split_at(START.into());
            let (start, gap) = start.split_at(code.len());
            assert!(start == code, "{}", path.display());
            assert!(gap.iter().all(|byte| *byte == BLANK));
            assert!(section == robot.section(), "{}", path.display());
            let alone_image = robot_alone(&robot).expect("it fits");
            assert!(alone_image.bytes() == section);
            assert_eq!(alone_image.end(), image.end());
            count += 1;
        }
        assert!(count >= 4, "{count} robots");
    }

    #[test]
    fn the_error_names_a_file_that_is_not_an_image() {
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), "[servo]\n").expect("it is written");
        let message = read_hex_image(file.path())
            .expect_err("it is not an image")
            .to_string();
        let name = file.path().display();
        assert_eq!(
            message,
            format!("{name}: line 1 is not Intel HEX: missing start code ':'")
        );
    }
}
