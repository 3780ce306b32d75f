//! `lizard new`: writes a robot.toml as a starting point.

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use crate::Failure;
use crate::shared::{files, robot_args};

/// Write a new robot.toml with a comment on every key
///
/// The file describes the paper's robot. An existing file is not overwritten.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard new my.toml && lizard gaits --robot my.toml
  lizard new robot.toml    # commands in this folder and below find it without --robot")]
pub struct Args {
    /// Path of the new file
    file: PathBuf,
}

/// Writes the file.
///
/// # Errors
/// Fails if the file already exists or cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let name = args.file.display();
    let mut file = files::create_new(&args.file, "choose another name")?;
    if let Err(error) = file.write_all(robot_args::DEFAULT_ROBOT_TOML.as_bytes()) {
        // Other commands would read an incomplete robot.toml.
        let _ = fs::remove_file(&args.file);
        return Err(files::write_failure(&args.file, &error));
    }
    writeln!(
        io::stdout(),
        "wrote the paper's robot to {name}; edit it, then check it: lizard gaits --robot {name}"
    )?;
    Ok(())
}
