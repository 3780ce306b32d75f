//! `lizard measure slope`: measures the friction of a robot that slides down a tilted board.

use std::fmt::Write as _;
use std::path::PathBuf;

use lizard_film::{Figure, Slide};
use lizard_measure::{NamedFilm, board_height};
use lizard_robot::Robot;
use serde::Serialize;

use super::figures::{self, MeasuredKey};
use super::film::film_failure;
use super::filming::{Filming, parse_height};
use crate::shared::json;
use crate::shared::progress::Spinner;
use crate::{Failure, RobotFile};

/// Measure in films of a tilted board the friction of the robot's pads, for robot.toml
///
/// Each FILM shows the robot on a board between the two strips, from a camera that stands still. It begins with the
/// board level; then one end is lifted slowly until the robot slides. Prints the friction of sliding pads with its
/// standard error, and static friction beside it. Films with the head downhill give friction forward, with the head
/// uphill backward.
#[derive(clap::Args, Debug)]
#[command(after_help = "Example:
  lizard measure slope downhill.mp4 uphill.mp4")]
pub struct SlopeArgs {
    /// Folders of pictures (PNG or JPEG), or films
    #[arg(value_name = "FILM", required = true)]
    films: Vec<PathBuf>,
    /// Height of the deck's tag above the strips, mm [default: the top of the board, by the robot's parts]
    #[arg(long, value_name = "MM", value_parser = parse_height)]
    height: Option<f64>,
    #[command(flatten)]
    filming: Filming,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// The result, with the field names of `--json`.
#[derive(Serialize)]
struct Report {
    films: Vec<SlideLine>,
    figures: Vec<MeasuredKey>,
}

/// The slide in a film. Pairs are a value and its standard error.
#[derive(Serialize)]
struct SlideLine {
    film: String,
    is_head_first: bool,
    /// Tilt at which the slide begins, deg.
    tilt: [f64; 2],
    /// Coefficient of static friction.
    resting: [f64; 2],
    /// Coefficient of sliding friction.
    sliding: [f64; 2],
}

/// Measures slides and prints the result.
///
/// # Errors
/// Fails for a film that cannot be read or shows no slide.
pub fn measure_slope(args: SlopeArgs) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let height = args.height.unwrap_or_else(|| board_height(&robot));
    let setup = args.filming.setup(height);
    let spinner = Spinner::new("reading the pictures");
    let slide_of = |path: &PathBuf| {
        let NamedFilm { name, analysis } = args.filming.analyse(path, setup)?;
        let slide = Slide::of(&analysis).map_err(|error| film_failure(&name, &error))?;
        Ok((name, slide))
    };
    let slides: Vec<(String, Slide)> = args
        .films
        .iter()
        .map(slide_of)
        .collect::<Result<_, Failure>>()?;
    drop(spinner);
    let report = Report::new(&robot, &slides);
    json::print_json_or_text(args.json, &report, || report.text())
}

/// Averages figures that share a systematic error, such as that of the level board; `None` if `figures` is empty.
fn mean_figure(figures: &[Figure]) -> Option<Figure> {
    let count = figures.len() as f64;
    let mean_of =
        |value_of: &dyn Fn(&Figure) -> f64| figures.iter().map(value_of).sum::<f64>() / count;
    let value = mean_of(&|figure| figure.value);
    let variance = mean_of(&|figure| (figure.value - value).powi(2)) / (count - 1.0).max(1.0);
    (!figures.is_empty()).then(|| Figure {
        value,
        error: mean_of(&|figure| figure.error).hypot(variance.sqrt()),
    })
}

impl Report {
    fn new(robot: &Robot, slides: &[(String, Slide)]) -> Self {
        let friction_of = |is_head_first: bool| {
            let slides = slides
                .iter()
                .filter(|(_, slide)| slide.is_head_first == is_head_first);
            mean_figure(
                &slides
                    .map(|(_, slide)| slide.sliding_friction)
                    .collect::<Vec<_>>(),
            )
        };
        let (forward, backward) = (friction_of(true), friction_of(false));
        let mut figures = Vec::new();
        let ground = robot.ground();
        if let Some(forward) = forward {
            figures.push(MeasuredKey::new(
                "ground",
                "friction",
                3,
                forward,
                ground.friction_coefficient,
            ));
            if let Some(backward) = backward {
                let value = backward.value / forward.value;
                let relative_error =
                    (backward.error / backward.value).hypot(forward.error / forward.value);
                let ratio = Figure {
                    value,
                    error: value * relative_error,
                };
                let key = "friction_back_over_forward";
                figures.push(MeasuredKey::new(
                    "ground",
                    key,
                    3,
                    ratio,
                    ground.friction_ratio,
                ));
            }
        }
        let value_and_error = |figure: Figure| [figure.value, figure.error];
        let line_of = |(film, slide): &(String, Slide)| SlideLine {
            film: film.clone(),
            is_head_first: slide.is_head_first,
            tilt: value_and_error(slide.tilt),
            resting: value_and_error(slide.static_friction),
            sliding: value_and_error(slide.sliding_friction),
        };
        Self {
            films: slides.iter().map(line_of).collect(),
            figures,
        }
    }

    fn text(&self) -> String {
        let mut text =
            "slides first  begins at, deg   static friction  sliding friction\n".to_owned();
        for line in &self.films {
            let end_name = if line.is_head_first { "head" } else { "tail" };
            let format_pair = |[value, error]: [f64; 2], digits: usize| {
                format!("{value:.digits$} to {error:.digits$}")
            };
            let _ = writeln!(
                text,
                "{end_name:<14}{:<17}{:<17}{:<18}{}",
                format_pair(line.tilt, 1),
                format_pair(line.resting, 3),
                format_pair(line.sliding, 3),
                line.film
            );
        }
        if self.figures.is_empty() {
            return text
                + "\nfriction in robot.toml is that of pads which slide head first: film the robot with its head \
                   downhill, too\n";
        }
        let table = figures::table_text(&self.figures);
        let _ = write!(text, "\n{table}\n{}", figures::toml_lines(&self.figures));
        if self.figures.len() == 1 {
            text += "A film with the head uphill gives friction_back_over_forward.\n";
        }
        text
    }
}
