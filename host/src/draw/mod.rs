//! `lizard draw`: the robot from above.

pub mod ink;
mod labels;
mod top_view;

use std::io::{self, Write};
use std::path::PathBuf;

use crate::{Failure, PoseArgs, RobotFile};

pub use labels::pin_name;
pub use top_view::top_view;

/// Draw the robot from above as SVG
///
/// At neutral, or at the pose given by --theta1 and so on.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Where the picture goes [default: standard output]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Leave out names and measures
    #[arg(long)]
    plain: bool,
    #[command(flatten)]
    pose: PoseArgs,
    #[command(flatten)]
    robot: RobotFile,
}

/// Draws the robot.
///
/// # Errors
/// A pose that the robot cannot have, or a file that cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let pose = args.pose.get().unwrap_or_else(|| robot.neutral());
    let solution = robot
        .lizard()
        .solve(&pose)
        .map_err(|infeasible| Failure::Impossible(infeasible.to_string()))?;
    let picture = top_view(&robot, &solution, !args.plain);
    match args.output {
        Some(path) => std::fs::write(&path, picture).map_err(|error| {
            Failure::Impossible(format!("cannot write {}: {error}", path.display()))
        }),
        None => Ok(io::stdout().lock().write_all(picture.as_bytes())?),
    }
}
