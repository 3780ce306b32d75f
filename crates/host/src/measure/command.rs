//! `lizard measure`: measures the robot's displacement per cycle in videos.

use std::io::{self, Write};
use std::path::PathBuf;

use lizard_measure::{Gaits, Report, compute_deck_height};

use super::picture;
use super::recording::{RecordingArgs, height_parser};
use crate::shared::number::whole_number_parser;
use crate::shared::progress::create_spinner;
use crate::shared::robot_args::find_moving_gait;
use crate::shared::{files, json};
use crate::{Failure, RobotArgs};

/// Measure the robot's displacement per cycle in videos, and compare it with the prediction
///
/// VIDEO is a video that the program ffmpeg can read, or a folder of frames. It shows the robot from above with the
/// tags of `lizard measure sheet`, and one or several gaits with rests between them. For each gait, prints the
/// displacement forward, the drift to the left and the turn per cycle: the mean, the spread of single cycles, the
/// standard error of the mean (the true value is within two standard errors in 95 % of videos), and the contact model's
/// prediction with the servos from robot.toml. Also prints the phase at which the path deviates most from the
/// prediction.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard measure sheet
  lizard measure video.mp4 --gait walk
  lizard measure video.mp4 --gait walk,left,walk --picture measured.svg
  lizard measure frames --fps 30 --height 85 --ruler 97.2")]
pub struct Args {
    /// Videos, or folders of frames (PNG or JPEG)
    #[arg(value_name = "VIDEO", required = true)]
    videos: Vec<PathBuf>,
    /// The gaits of the walks between rests, in their order, or one gait for all walks [default: the gaits in
    /// robot.toml that the paths clearly resemble]
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "NAMES", value_delimiter = ',')]
    gait: Vec<String>,
    /// The robot's setting `speed` in the videos, percent
    #[arg(long, value_name = "PERCENT", default_value_t = 100, value_parser = whole_number_parser::<u8>(1, 100))]
    speed: u8,
    /// Height of the deck's tag above the floor, mm [default: the top of the board, computed from the robot's parts]
    #[arg(long, value_name = "MM", value_parser = height_parser())]
    height: Option<f64>,
    #[command(flatten)]
    recording: RecordingArgs,
    /// Draw the measured and the predicted paths and displacements of a cycle, as SVG
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Print only the robot's path in one video, as CSV: seconds,forward,left,heading; mm and degrees on the floor
    #[arg(long, conflicts_with_all = ["json", "picture", "gait"])]
    csv: bool,
    #[command(flatten)]
    robot: RobotArgs,
}

/// Measures videos and prints the result.
///
/// # Errors
/// Fails if the robot does not have a named gait, if a named gait moves no servo, if a video cannot be read or shows no
/// measurable gait, if several videos are given with `--csv`, or if a file cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    if args.csv && args.videos.len() > 1 {
        return Err(Failure::Input("--csv requires a single video".to_owned()));
    }
    let robot = args.robot.load()?;
    if let Some(path) = &args.picture {
        files::check_replaceable(path)?;
    }
    let named_gaits = args.gait.iter().map(|name| find_moving_gait(&robot, name));
    let named_gaits = named_gaits.collect::<Result<Vec<_>, _>>()?;
    let gaits = Gaits::predict(&robot, &named_gaits, args.speed);
    let height = args.height.unwrap_or_else(|| compute_deck_height(&robot));
    let setup = args.recording.setup(height);
    let spinner = create_spinner("reading the frames");
    let analyse_video = |path: &PathBuf| args.recording.analyse(path, setup);
    let analyses = args.videos.iter().map(analyse_video);
    let videos = analyses.collect::<Result<Vec<_>, Failure>>()?;
    if args.csv {
        drop(spinner);
        let csv = videos[0].format_path_csv();
        return Ok(io::stdout().lock().write_all(csv.as_bytes())?);
    }
    let walks = gaits.measure_walks(&videos).map_err(Failure::Input)?;
    let report = Report::compute(args.robot.text()?, setup, &videos, &gaits, &walks);
    drop(spinner);
    if let Some(path) = args.picture {
        files::write(&path, picture::draw(&report).as_bytes())?;
    }
    json::print_json_or_text(args.json, &report, || report.format_text())
}
