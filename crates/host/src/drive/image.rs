//! `lizard flash image`: writes the firmware and a robot to a file.
//!
//! `lizard flash` writes to a board. A user with another programmer, or with a board on another machine, needs a file.

use std::io::{self, Write};
use std::path::PathBuf;

use lizard_core::numbers::section::REGION_BYTES;
use lizard_robot::RobotIdentity;
use serde::Serialize;

use crate::drive::flash::image_source;
use crate::shared::{files, json};
use crate::{Failure, RobotArgs};

/// Write the firmware and your robot to an Intel HEX file, without a compiler
///
/// The image is the built-in firmware followed by the robot from robot.toml, as `lizard flash`
/// writes it. avrdude and other programs can write it, too.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The file for the image [default: standard output, unless that is a terminal]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Only the robot, for a board with this firmware; avrdude -D leaves the rest unchanged
    #[arg(long)]
    only_robot: bool,
    /// Print one JSON object about the file
    #[arg(long, requires = "output")]
    json: bool,
    #[command(flatten)]
    robot: RobotArgs,
}

/// The description of an image file; the field names are the JSON keys.
#[derive(Serialize)]
struct ImageFile {
    file: String,
    /// The firmware's version; null in a file with only the robot.
    firmware: Option<&'static str>,
    robot: RobotIdentity,
    /// The size of the robot's section, bytes.
    robot_bytes: usize,
    /// The flash space reserved for the robot's section, bytes.
    robot_space: u16,
}

/// Runs `lizard flash image`.
///
/// # Errors
/// Fails if the robot is invalid, standard output is a terminal, or the file cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    files::check_no_terminal(args.output.as_deref(), "image", "lizard.hex")?;
    let robot = args.robot.load()?;
    let hex = image_source::build_image(&robot, args.only_robot)?.to_hex();
    let Some(path) = args.output else {
        return Ok(io::stdout().lock().write_all(hex.as_bytes())?);
    };
    files::write(&path, hex.as_bytes())?;
    if files::is_standard_output(&path) {
        return Ok(());
    }
    let image_file = ImageFile {
        file: path.display().to_string(),
        firmware: (!args.only_robot).then_some(env!("CARGO_PKG_VERSION")),
        robot: RobotIdentity::for_robot(robot.firmware()),
        robot_bytes: robot.section().len(),
        robot_space: REGION_BYTES,
    };
    json::print_json_or_text(args.json, &image_file, || {
        let firmware = image_file.firmware;
        let firmware_text = firmware.map_or(String::new(), |version| format!("lizard {version} "));
        format!(
            "{}: {firmware_text}robot {} {}; the robot has {} of {REGION_BYTES} bytes\n",
            image_file.file, image_file.robot.name, image_file.robot.hash, image_file.robot_bytes
        )
    })
}
