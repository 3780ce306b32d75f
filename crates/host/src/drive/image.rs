//! `lizard flash image`: the firmware with a robot as a file, for any program that writes boards.
//!
//! `lizard flash` writes a robot to a board. A user with another programmer, or with the board at
//! another machine, needs a file.

use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;

use lizard_core::numbers::section::SPACE;

use crate::drive::flash::file;
use crate::shared::{files, firmware};
use crate::{Failure, RobotFile};

/// Make the image of your robot as a file of Intel HEX, without a compiler
///
/// The image is the firmware inside this program with the robot of robot.toml behind it, as `lizard
/// flash` writes it. avrdude and other programs can write it, too.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The file for the image [default: standard output, unless that is a terminal]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Only the robot, for a board that has this firmware: avrdude -D leaves the rest as it is
    #[arg(long)]
    only_robot: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// Makes the image.
///
/// # Errors
/// Fails if the robot is wrong, or the file cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    if args.output.is_none() && io::stdout().is_terminal() {
        return Err(Failure::Input(
            "an image is not for a terminal; --output lizard.hex writes it to a file".to_owned(),
        ));
    }
    let robot = args.robot.load()?;
    let image = match args.only_robot {
        true => file::robot_alone(&robot)?,
        false => file::image(&robot)?,
    };
    let hex = image.to_hex();
    let Some(path) = args.output else {
        return Ok(io::stdout().lock().write_all(hex.as_bytes())?);
    };
    files::write(&path, hex.as_bytes())?;
    let content = match args.only_robot {
        true => String::new(),
        false => format!("lizard {} ", env!("CARGO_PKG_VERSION")),
    };
    writeln!(
        io::stdout(),
        "{}: {content}robot {}; the robot has {} of {SPACE} bytes",
        path.display(),
        firmware::label(robot.firmware()),
        robot.section().len(),
    )?;
    Ok(())
}
