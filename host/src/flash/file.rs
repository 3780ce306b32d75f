//! Where an image comes from, and an image as a file: `lizard image`.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use lizard_robot::Robot;

use super::image::Image;
use crate::{Failure, RobotFile, whole_file};

/// What `make firmware` leaves.
const BUILT: &str = "target/avr-atmega328p/release/lizard.hex";

/// Write firmware and robot into a file, to be written to a UNO by another program
///
/// The name's end tells the form: .hex is Intel HEX, .bin is flash from address 0, byte by
/// byte.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The file: x.hex or x.bin
    #[arg(long, short, value_name = "FILE", default_value = "lizard.hex")]
    output: PathBuf,
    #[command(flatten)]
    robot: RobotFile,
}

/// Writes the file.
///
/// # Errors
/// No firmware, a wrong robot.toml, or a file that cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let image = image(&args.robot.load()?)?;
    save(&image, &args.output)?;
    let (bytes, name) = (image.to_bytes().len(), args.output.display());
    writeln!(io::stdout(), "{name}: an image of {bytes} bytes of flash")?;
    Ok(())
}

/// The image of a robot: the one that `make firmware` has left in this folder or one above
/// it.
///
/// # Errors
/// There is none, or it is no image for a UNO.
pub fn image(_robot: &Robot) -> Result<Image, Failure> {
    let here = std::env::current_dir()?;
    let found = here
        .ancestors()
        .map(|folder| folder.join(BUILT))
        .find(|path| path.is_file());
    let missing = || {
        Failure::Input(format!(
            "there is no firmware at {BUILT}; build it with `make firmware`"
        ))
    };
    read(&found.ok_or_else(missing)?)
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

/// Writes an image into a file, whole or not at all.
fn save(image: &Image, path: &Path) -> Result<(), Failure> {
    match path.extension().and_then(OsStr::to_str) {
        Some("hex") => whole_file::write(path, image.to_hex().as_bytes()),
        Some("bin") => whole_file::write(path, &image.to_bytes()),
        _ => Err(Failure::Input(format!(
            "{}: the name must end in .hex or .bin",
            path.display()
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image() -> Image {
        Image::new(vec![7; 300], vec![8; 20]).expect("it fits")
    }

    #[test]
    fn an_image_is_saved_in_the_form_that_the_name_tells() {
        let folder = tempfile::tempdir().expect("a folder");
        let hex = folder.path().join("a.hex");
        save(&image(), &hex).expect("it is saved");
        assert_eq!(read(&hex).expect("it is read"), image());
        let bin = folder.path().join("a.bin");
        save(&image(), &bin).expect("it is saved");
        let bytes = std::fs::read(&bin).expect("it is read");
        assert_eq!(bytes.len(), 0x6a00 + 20);
        assert_eq!((bytes[299], bytes[300], bytes[0x6a00]), (7, 0xff, 8));
    }

    #[test]
    fn another_form_and_a_device_are_refused() {
        let words = |path: &str| {
            let error = save(&image(), Path::new(path)).expect_err("it is not saved");
            error.to_string()
        };
        assert_eq!(words("a.elf"), "a.elf: the name must end in .hex or .bin");
        assert_eq!(
            words("/dev/null"),
            "/dev/null: the name must end in .hex or .bin"
        );
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
