//! `lizard measure`: measures in films how far the gaits move the robot.

use std::io::{self, Write};
use std::path::PathBuf;

use lizard_measure::{Gaits, Report, board_height};
use lizard_robot::{CheckedGait, Robot};

use super::filming::{Filming, parse_height};
use super::picture;
use crate::shared::progress::Spinner;
use crate::shared::suggestion::suggestion_text;
use crate::shared::{files, json};
use crate::{Failure, RobotFile};

/// Measure in films how far the robot goes in a cycle of its gaits, beside the prediction
///
/// FILM is a folder of pictures, or a film that the program ffmpeg can read. It shows the robot from
/// above with the tags of `lizard measure sheet`, and one gait or several with rests between them. Prints for each
/// gait way ahead, drift to the left and turn of a cycle: the mean, the spread of single cycles, the standard error of
/// the mean (the truth lies within two of it in 95 % of films), and what the contact model predicts with the servos of
/// robot.toml; then where in the cycle the path is farthest from the predicted one.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard measure sheet
  lizard measure film.mp4 --gait walk
  lizard measure film.mp4 --gait walk,left,walk --picture measured.svg
  lizard measure pictures --fps 30 --height 85 --ruler 97.2")]
pub struct Args {
    /// Folders of pictures (PNG or JPEG), or films
    #[arg(value_name = "FILM", required = true)]
    films: Vec<PathBuf>,
    /// The gaits of the walks between rests, in their order, or one for all [default: the gaits of robot.toml that
    /// the paths are clearly like]
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "NAMES", value_delimiter = ',')]
    gait: Vec<String>,
    /// The pace at which it was driven, percent
    #[arg(long, value_name = "PERCENT", default_value_t = 100, value_parser = clap::value_parser!(u8).range(1..=100))]
    speed: u8,
    /// Height of the deck's tag above the floor, mm [default: the top of the board, by the robot's parts]
    #[arg(long, value_name = "MM", value_parser = parse_height)]
    height: Option<f64>,
    #[command(flatten)]
    filming: Filming,
    /// Draw the paths within a cycle and the ways beside the predicted ones, as SVG
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Print instead the robot's path in one film as CSV: seconds,forward,left,heading; mm and degrees on the floor
    #[arg(long, conflicts_with_all = ["json", "picture", "gait"])]
    csv: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// Measures films and prints the result.
///
/// # Errors
/// Fails for a gait that the robot does not have or that moves no servo, a film that cannot be read or shows no
/// measurable gait, several films with `--csv`, or a file that cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let pace = f64::from(args.speed) / 100.0;
    let named_gaits = args.gait.iter().map(|name| find_gait(&robot, name));
    let gaits = Gaits::new(&robot, &named_gaits.collect::<Result<Vec<_>, _>>()?, pace);
    let height = args.height.unwrap_or_else(|| board_height(&robot));
    let setup = args.filming.setup(height);
    let spinner = Spinner::new("reading the pictures");
    let analyse_film = |path: &PathBuf| args.filming.analyse(path, setup);
    let films = args.films.iter().map(analyse_film);
    let films = films.collect::<Result<Vec<_>, Failure>>()?;
    if args.csv {
        drop(spinner);
        return match &films[..] {
            [film] => Ok(io::stdout().lock().write_all(film.path_csv().as_bytes())?),
            _ => Err(Failure::Input("--csv has the path of one film".to_owned())),
        };
    }
    let walks = gaits.measure_walks(&films).map_err(Failure::Input)?;
    let report = Report::new(&robot, args.speed, setup, &films, &gaits, &walks)
        .with_ranges(&robot)
        .with_mujoco(&args.robot.text()?);
    drop(spinner);
    if let Some(path) = args.picture {
        files::write(&path, picture::draw(&report).as_bytes())?;
    }
    json::print_json_or_text(args.json, &report, || report.text())
}

/// Finds the gait that is called `name`.
///
/// # Errors
/// Fails if the robot has no such gait, or if the gait moves no servo.
fn find_gait<'a>(robot: &'a Robot, name: &str) -> Result<&'a CheckedGait, Failure> {
    match robot.gait(name) {
        Some(gait) if gait.has_movement() => Ok(gait),
        Some(_) => Err(Failure::Input(format!("the gait `{name}` moves no servo"))),
        None => {
            let moving_gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
            let names: Vec<&str> = moving_gaits.map(CheckedGait::name).collect();
            Err(Failure::Input(format!(
                "robot.toml has no gait `{name}`; those that move are {}{}",
                names.join(", "),
                suggestion_text(name, names)
            )))
        }
    }
}
