//! `lizard draw`: draws the robot from above, its wiring, and the angles of its cranks.

mod body;
mod cranks;
mod labels;
mod route;
mod top_view;
mod uno;
mod wiring;

use std::io::{self, Write};
use std::path::PathBuf;

use crate::shared::files;
use crate::{Failure, PoseArgs, RobotArgs};

pub use cranks::draw_cranks;
pub use top_view::draw_top_view;
pub use wiring::draw_wiring;

/// Draw the robot from above, its wiring, or its cranks, as SVG
///
/// The view from above shows the neutral pose, or the pose given by --theta1, --theta4,
/// --theta8 and --theta5. --wiring and --horns make drawings for building the robot.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Output file for the picture [default: standard output, unless it is a terminal]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Omit names and dimensions
    #[arg(long)]
    plain: bool,
    /// Draw the wiring: servos, supply, board
    #[arg(long, conflicts_with_all = ["plain", "theta1", "horns"])]
    wiring: bool,
    /// Draw the angles at which the cranks are fitted, and the effect of a trim
    #[arg(long, conflicts_with_all = ["plain", "theta1"])]
    horns: bool,
    #[command(flatten)]
    pose: PoseArgs,
    #[command(flatten)]
    robot: RobotArgs,
}

/// Draws the robot.
///
/// # Errors
/// Fails if robot.toml is invalid, if the pose is impossible, or if the output cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    files::check_no_terminal(args.output.as_deref(), "SVG", "lizard.svg")?;
    let robot = args.robot.load()?;
    let picture = if args.wiring {
        draw_wiring(&robot)
    } else if args.horns {
        draw_cranks(&robot)
    } else {
        let pose = args.pose.to_pose().unwrap_or_else(|| robot.neutral_pose());
        let solution = robot.lizard().solve(&pose)?;
        draw_top_view(&robot, &solution, !args.plain)
    };
    match args.output {
        Some(path) => files::write(&path, picture.as_bytes()),
        None => Ok(io::stdout().lock().write_all(picture.as_bytes())?),
    }
}
