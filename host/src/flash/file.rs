//! Where an image comes from.

use std::path::Path;

use lizard_core::section::START;
use lizard_robot::Robot;

use super::image::Image;
use crate::Failure;

/// What `make firmware` leaves.
const BUILT: &str = "target/avr-atmega328p/release/lizard.hex";

/// The image of a robot: the code that `make firmware` has left in this folder or one above
/// it, with this robot's section behind it.
///
/// # Errors
/// There is none, or it is no image for a UNO.
pub fn image(robot: &Robot) -> Result<Image, Failure> {
    let here = std::env::current_dir()?;
    image_of(robot, &here)
}

fn image_of(robot: &Robot, here: &Path) -> Result<Image, Failure> {
    let found = here
        .ancestors()
        .map(|folder| folder.join(BUILT))
        .find(|path| path.is_file());
    let missing = || {
        Failure::Input(format!(
            "there is no firmware at {BUILT}; build it with `make firmware`"
        ))
    };
    let path = found.ok_or_else(missing)?;
    let mut bytes = read(&path)?.bytes().to_vec();
    bytes.resize(START.into(), 0xff);
    bytes.extend(robot.section());
    Image::new(bytes).map_err(|error| Failure::Input(format!("{}: {error}", path.display())))
}

/// Reads an image from a file of Intel HEX.
///
/// # Errors
/// It cannot be read, or is no image for a UNO.
pub fn read(path: &Path) -> Result<Image, Failure> {
    let name = path.display();
    let text = std::fs::read_to_string(path)
        .map_err(|error| Failure::Input(format!("cannot read {name}: {error}")))?;
    Image::from_hex(&text).map_err(|error| Failure::Input(format!("{name}: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_code_that_was_built_gets_the_robot_that_was_asked_for() {
        let folder = tempfile::tempdir().expect("a folder");
        let built = folder.path().join(BUILT);
        let robot = |name: &str| {
            let path = format!("{}/../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            Robot::load(Path::new(&path)).expect("it is right")
        };
        let [paper, other] = ["paper", "unequal"].map(robot);
        let words = image_of(&paper, folder.path()).expect_err("there is none");
        assert!(
            words
                .to_string()
                .starts_with("there is no firmware at target/")
        );
        std::fs::create_dir_all(built.parent().expect("a folder")).expect("it is made");
        // With a longer section than either has.
        let image = Image::new(vec![7; 0x7e00]).expect("it fits");
        std::fs::write(&built, image.to_hex()).expect("it is written");
        let inside = folder.path().join("a/b");
        std::fs::create_dir_all(&inside).expect("it is made");
        for robot in [&paper, &other] {
            let image = image_of(robot, &inside).expect("it is found");
            let (code, section) = image.bytes().split_at(START.into());
            assert!(code.iter().all(|byte| *byte == 7));
            assert_eq!(section, robot.section());
        }
    }

    #[test]
    fn a_file_that_is_no_image_is_named() {
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), "[servo]\n").expect("it is written");
        let words = read(file.path()).expect_err("it is no image").to_string();
        let name = file.path().display();
        assert_eq!(
            words,
            format!("{name}: line 1 is no Intel HEX: missing start code ':'")
        );
    }
}
