//! `lizard draw charts`: draws the paper's figures and additional charts, as SVG.

mod performance;
mod reach;
mod singularity;
mod slider_travel;
mod workspace;

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use lizard_robot::Robot;
use serde::Serialize;

use crate::make::draw;
use crate::paper::design;
use crate::shared::plot::Plot;
use crate::shared::{files, json};
use crate::{Failure, PoseArgs, RobotArgs};

/// Grid step of the performance charts, in units of D.
const GRID_STEP: f64 = 0.005;
/// Number of sampling rings in each inscribed circle of the performance charts.
const RING_COUNT: usize = 16;

/// Draw all charts as SVG files
///
/// The charts are: workspace (with the maximal inscribed circle), workspaces (of tail, body and legs), conditioning
/// (the LCI map), performance (over the whole design space), singularity (with the gaits' paths), stroke (slider travel
/// in each gait), top-view (at neutral, or at the given pose).
#[derive(clap::Args, Debug)]
#[command(after_help = "Example:
  lizard draw charts docs/charts")]
pub struct Args {
    /// Output folder; it is created if it does not exist
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Print the list of files as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    pose: PoseArgs,
    #[command(flatten)]
    robot: RobotArgs,
}

/// A chart and its files; the field names are the JSON keys.
#[derive(Serialize)]
struct ChartFiles {
    chart: &'static str,
    files: Vec<PathBuf>,
}

/// Draws all charts and writes them.
///
/// # Errors
/// Fails if robot.toml is invalid, or if the folder or a file cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let pose = args.pose.to_pose().unwrap_or_else(|| robot.neutral_pose());
    let solution = robot.lizard().solve(&pose)?;
    // The charts take seconds to compute. The folder is created first so that an invalid folder fails at once.
    fs::create_dir_all(&args.folder).map_err(|error| files::write_failure(&args.folder, &error))?;
    let mut pictures = draw_charts(&robot);
    pictures.push(("top-view", draw::draw_top_view(&robot, &solution, true)));
    let chart_files: Vec<ChartFiles> = pictures
        .iter()
        .map(|(name, svg)| {
            let path = args.folder.join(format!("{name}.svg"));
            files::write(&path, svg.as_bytes())?;
            let files = vec![path];
            Ok(ChartFiles { chart: name, files })
        })
        .collect::<Result<_, Failure>>()?;
    if args.json {
        json::write_line(&mut io::stdout().lock(), &chart_files)?;
    } else {
        for file in chart_files.iter().flat_map(|chart| &chart.files) {
            writeln!(io::stdout(), "{}", file.display())?;
        }
    }
    Ok(())
}

/// Draws every chart that does not depend on a pose. Returns each chart's name and SVG text.
fn draw_charts(robot: &Robot) -> Vec<(&'static str, String)> {
    let points = design::compute_points(GRID_STEP, RING_COUNT);
    vec![
        ("workspace", workspace::draw_workspace(robot)),
        ("workspaces", reach::draw_workspaces(robot)),
        ("conditioning", workspace::draw_conditioning(robot)),
        (
            "performance",
            performance::draw_performance(&points, GRID_STEP),
        ),
        ("singularity", singularity::draw_singularities(robot)),
        ("stroke", slider_travel::draw_slider_travel(robot)),
    ]
}

/// Returns a square plot of this width, px, whose axes have the same range.
fn square_plot(corner: (f64, f64), width: f64, range: (f64, f64)) -> Plot {
    Plot {
        corner,
        size: (width, width),
        x_range: range,
        y_range: range,
    }
}
