//! `lizard new`: writes a robot.toml to start from.

use std::fs::File;
use std::io::{self, ErrorKind, Write};
use std::path::PathBuf;

use crate::Failure;
use crate::shared::{files, robot_file};

/// Write a robot.toml to begin with: every key with a comment
///
/// It is the robot of the paper. A file that is already there is left as it is.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard new my.toml && lizard gaits --robot my.toml
  lizard new robot.toml    # commands in this folder and below find it without --robot")]
pub struct Args {
    /// The new file
    file: PathBuf,
}

/// Writes the file.
///
/// # Errors
/// Fails if the file already exists or cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let name = args.file.display();
    let file = File::create_new(&args.file);
    let result =
        file.and_then(|mut file| file.write_all(robot_file::DEFAULT_ROBOT_TOML.as_bytes()));
    result.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Failure::Input(format!(
            "{name} already exists and is left as it is; name a new file"
        )),
        _ => files::write_failure(&args.file, &error),
    })?;
    writeln!(
        io::stdout(),
        "{name} is the paper's robot; change it, then check it: lizard gaits --robot {name}"
    )?;
    Ok(())
}
