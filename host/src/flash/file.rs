//! Where an image comes from.

use std::path::Path;

use lizard_robot::Robot;

use super::image::Image;
use crate::Failure;

/// What `make firmware` leaves.
const BUILT: &str = "target/avr-atmega328p/release/lizard.hex";

/// The image of a robot: the one that `make firmware` has left in this folder or one above
/// it.
///
/// # Errors
/// There is none, it is for another robot, or it is no image for a UNO.
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
    // What the build found out about the gaits is beside the firmware, with the robot's hash.
    let wanted = format!("tables {:08x}", robot.firmware().hash());
    let gaits = std::fs::read_to_string(path.with_file_name("gaits.txt")).unwrap_or_default();
    if !gaits
        .lines()
        .next()
        .is_some_and(|line| line.ends_with(&wanted))
    {
        return Err(Failure::Input(format!(
            "{}: the firmware there was built for another robot; build it for this one, \
             `make firmware ROBOT=...`, without ROBOT= for robot.toml",
            path.display()
        )));
    }
    read(&path)
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
    fn firmware_that_was_built_for_another_robot_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let built = folder.path().join(BUILT);
        let beside = built.with_file_name("gaits.txt");
        let robot = |name: &str| {
            let path = format!("{}/../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            Robot::load(Path::new(&path)).expect("it is right")
        };
        let [paper, other] = ["paper", "unequal"].map(robot);
        let words = || {
            let error = image_of(&paper, folder.path()).expect_err("it is refused");
            error.to_string()
        };
        assert!(words().starts_with("there is no firmware at target/"));
        std::fs::create_dir_all(built.parent().expect("a folder")).expect("it is made");
        let image = Image::new(vec![7; 300]).expect("it fits");
        std::fs::write(&built, image.to_hex()).expect("it is written");
        assert!(
            words().contains("was built for another robot"),
            "{}",
            words()
        );
        for robot in [&other, &paper] {
            let line = format!("9 gaits, tables {:08x}\n\ngait\n", robot.firmware().hash());
            std::fs::write(&beside, line).expect("it is written");
            let found = image_of(&paper, folder.path());
            assert_eq!(
                found.is_ok(),
                robot.firmware().hash() == paper.firmware().hash(),
                "{found:?}"
            );
        }
        let inside = folder.path().join("a/b");
        std::fs::create_dir_all(&inside).expect("it is made");
        assert_eq!(image_of(&paper, &inside).expect("it is found"), image);
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
