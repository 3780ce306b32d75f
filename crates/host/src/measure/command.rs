//! `lizard measure`: the way of a gait in a film.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use lizard_film::{Film, Setup, Trouble, sheet};
use lizard_measure::{Report, expected, height_of_board};
use lizard_robot::{CheckedGait, Robot};

use super::{frames, grey, through_ffmpeg};
use crate::shared::files::note_input;
use crate::shared::json;
use crate::shared::progress::Spinner;
use crate::shared::suggestion::did_you_mean;
use crate::{Failure, RobotFile};

/// Lengths of the ruler of 100 mm that a printer may make of it, mm.
const RULER: [f64; 2] = [85.0, 115.0];

/// Measure in a film how far the robot goes in a cycle of a gait, beside the prediction
///
/// FILM is a folder of pictures, or a film that the program ffmpeg can read. It shows the robot from
/// above with the tags of `lizard measure sheet`. Prints way ahead, drift to the left and turn of a
/// cycle: the mean, the spread of single cycles, the standard error of the mean (the truth lies
/// within two of it in 95 % of films), and what the contact model predicts with the servos of robot.toml.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard measure sheet
  lizard measure film.mp4 --gait walk
  lizard measure pictures --fps 30 --gait left --height 85 --ruler 97.2")]
pub struct Args {
    /// A folder of pictures (PNG or JPEG), or a film
    #[arg(value_name = "FILM", required = true)]
    film: Option<PathBuf>,
    /// The gait that the robot walks in the film
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "NAME", required = true)]
    gait: Option<String>,
    /// The pace at which it was driven, percent
    #[arg(long, value_name = "PERCENT", default_value_t = 100, value_parser = clap::value_parser!(u8).range(1..=100))]
    speed: u8,
    /// Pictures in a second [default: by the film, or by the names of pictures, as 1.033s.png]
    #[arg(long, value_name = "RATE", value_parser = rate)]
    fps: Option<f64>,
    /// Height of the deck's tag above the floor, mm [default: the top of the board, by the robot's parts]
    #[arg(long, value_name = "MM", value_parser = height)]
    height: Option<f64>,
    /// Length of the line on a strip that should be 100 mm long
    #[arg(long, value_name = "MM", default_value_t = sheet::RULER, value_parser = ruler)]
    ruler: f64,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Print instead the robot's path as CSV: seconds,forward,left,heading; mm and degrees on the floor
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    #[command(flatten)]
    robot: RobotFile,
}

pub(super) fn number(word: &str, [low, high]: [f64; 2], meaning: &str) -> Result<f64, String> {
    let number = word
        .parse()
        .ok()
        .filter(|value| (low..=high).contains(value));
    number.ok_or_else(|| format!("{meaning}, between {low} and {high}"))
}

pub(super) fn rate(word: &str) -> Result<f64, String> {
    number(word, [1.0, 1000.0], "it is pictures in a second")
}

pub(super) fn height(word: &str) -> Result<f64, String> {
    number(word, [0.0, 500.0], "it is mm")
}

pub(super) fn ruler(word: &str) -> Result<f64, String> {
    number(
        word,
        RULER,
        "it is the line of 100 mm as a ruler measures it in mm",
    )
}

/// Measures a film and prints the result.
///
/// # Errors
/// Fails for a gait that the robot does not have, a film that cannot be read, or one that does not show
/// what is needed.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let gait = gait(&robot, args.gait.as_deref().unwrap_or_default())?;
    let pace = f64::from(args.speed) / 100.0;
    let height = args.height.unwrap_or_else(|| height_of_board(&robot));
    let setup = Setup {
        scale: args.ruler / sheet::RULER,
        height,
    };
    let path = args.film.as_deref().unwrap_or(Path::new(""));
    let about = |trouble: Trouble| Failure::Input(format!("{}: {trouble}", path.display()));
    let spinner = Spinner::new("reading the pictures");
    let film = read(path, args.fps, about)?;
    let expected = expected(&robot, gait, pace);
    let watched = film.watch(setup).map_err(about)?;
    let measured = watched.measure(&expected, None).map_err(about)?;
    drop(spinner);
    let report = Report::new(
        &robot, gait, args.speed, setup, &expected, &watched, &measured,
    );
    if args.csv {
        io::stdout().lock().write_all(report.path().as_bytes())?;
        return Ok(());
    }
    json::print_json_or(args.json, &report, || report.text())
}

/// Reads a film.
pub(super) fn read(
    path: &Path,
    rate: Option<f64>,
    about: impl Fn(Trouble) -> Failure,
) -> Result<Film, Failure> {
    let mut film = Film::default();
    if path.is_dir() {
        for (seconds, file) in frames::of_folder(path, rate)? {
            film.add(seconds, &grey::read(&file)?).map_err(&about)?;
        }
        return Ok(film);
    }
    if !path.is_file() {
        return Err(Failure::Input(format!(
            "there is no film {}",
            path.display()
        )));
    }
    through_ffmpeg::each(note_input(path), rate, |seconds, picture| {
        film.add(seconds, picture).map(|_| ()).map_err(&about)
    })?;
    Ok(film)
}

/// The gait of this name, if it moves a servo.
fn gait<'a>(robot: &'a Robot, name: &str) -> Result<&'a CheckedGait, Failure> {
    match robot.gait(name) {
        Some(gait) if gait.moves() => Ok(gait),
        Some(_) => Err(Failure::Input(format!("the gait `{name}` moves no servo"))),
        None => {
            let moving = robot.gaits().iter().filter(|gait| gait.moves());
            let names: Vec<&str> = moving.map(CheckedGait::name).collect();
            Err(Failure::Input(format!(
                "robot.toml has no gait `{name}`; those that move are {}{}",
                names.join(", "),
                did_you_mean(name, names)
            )))
        }
    }
}
