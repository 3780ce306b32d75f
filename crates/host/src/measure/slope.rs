//! `lizard measure slope`: measures the friction of a robot that slides down a tilted board.

use std::fmt::Write as _;
use std::path::PathBuf;

use lizard_measure::{NamedVideo, compute_deck_height};
use lizard_robot::Robot;
use lizard_video::{Estimate, MeasuredSlide};
use serde::Serialize;

use super::measured_key::{self, MeasuredKey};
use super::recording::{RecordingArgs, height_parser};
use super::video::video_failure;
use crate::shared::json;
use crate::shared::progress::create_spinner;
use crate::{Failure, RobotArgs};

/// Measure the friction of the robot's pads in videos of a tilted board, for robot.toml
///
/// Each VIDEO shows the robot on a board between the two strips, from a camera that stands still. The board is level at
/// the start; then one end is lifted slowly until the robot slides. Prints sliding and static friction with their
/// standard errors. Videos with the head downhill give the friction forward, videos with the head uphill the friction
/// backward.
#[derive(clap::Args, Debug)]
#[command(after_help = "Example:
  lizard measure slope downhill.mp4 uphill.mp4")]
pub struct SlopeArgs {
    /// Videos, or folders of frames (PNG or JPEG)
    #[arg(value_name = "VIDEO", required = true)]
    videos: Vec<PathBuf>,
    /// Height of the deck's tag above the strips, mm [default: the top of the UNO board, computed from the robot's
    /// parts]
    #[arg(long, value_name = "MM", value_parser = height_parser())]
    height: Option<f64>,
    #[command(flatten)]
    recording: RecordingArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotArgs,
}

/// The result, as `--json` prints it.
#[derive(Serialize)]
struct Report {
    #[serde(rename = "videos")]
    slides: Vec<SlideReport>,
    #[serde(rename = "figures")]
    keys: Vec<MeasuredKey>,
}

/// The slide in a video. Pairs are a value and its standard error.
#[derive(Serialize)]
struct SlideReport {
    video: String,
    /// True if the robot slides with its head downhill.
    is_head_first: bool,
    /// Tilt at which the slide begins, deg.
    tilt: [f64; 2],
    #[serde(rename = "resting")]
    static_friction: [f64; 2],
    #[serde(rename = "sliding")]
    sliding_friction: [f64; 2],
}

/// Measures slides and prints the result.
///
/// # Errors
/// Fails if a video cannot be read or shows no slide.
pub fn measure_slope(args: SlopeArgs) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let height = args.height.unwrap_or_else(|| compute_deck_height(&robot));
    let setup = args.recording.setup(height);
    let spinner = create_spinner("reading the frames");
    let measure_slide = |path: &PathBuf| {
        let NamedVideo { name, analysis } = args.recording.analyse(path, setup)?;
        let slide =
            MeasuredSlide::from_video(&analysis).map_err(|error| video_failure(&name, &error))?;
        Ok((name, slide))
    };
    let slides = args.videos.iter().map(measure_slide);
    let slides = slides.collect::<Result<Vec<_>, Failure>>()?;
    drop(spinner);
    let report = Report::new(&robot, &slides);
    json::print_json_or_text(args.json, &report, || report.format_text())
}

/// Averages estimates that have a systematic error in common, such as that of a board that is not quite level at the
/// start; `None` if `estimates` is empty.
fn average(estimates: &[Estimate]) -> Option<Estimate> {
    let count = estimates.len() as f64;
    let mean = |value: &dyn Fn(&Estimate) -> f64| estimates.iter().map(value).sum::<f64>() / count;
    let value = mean(&|estimate| estimate.value);
    let variance = mean(&|estimate| (estimate.value - value).powi(2)) / (count - 1.0).max(1.0);
    let standard_error = mean(&|estimate| estimate.standard_error).hypot(variance.sqrt());
    (!estimates.is_empty()).then(|| Estimate::new(value, standard_error))
}

impl Report {
    fn new(robot: &Robot, slides: &[(String, MeasuredSlide)]) -> Self {
        let average_friction = |is_head_first: bool| {
            let slides = slides.iter().map(|(_, slide)| slide);
            let slides = slides.filter(|slide| slide.is_head_first == is_head_first);
            let frictions: Vec<_> = slides.map(|slide| slide.sliding_friction).collect();
            average(&frictions)
        };
        let (forward, backward) = (average_friction(true), average_friction(false));
        let mut keys = Vec::new();
        let ground = robot.ground();
        let new_key =
            |name, estimate, value| MeasuredKey::new("ground", name, 3, estimate, value, 1.0);
        if let Some(forward) = forward {
            keys.push(new_key("friction", forward, ground.friction_coefficient));
            if let Some(backward) = backward {
                let value = backward.value / forward.value;
                let [backward_error, forward_error] =
                    [backward, forward].map(|friction| friction.standard_error / friction.value);
                let ratio = Estimate::new(value, value * backward_error.hypot(forward_error));
                let name = "friction_back_over_forward";
                keys.push(new_key(name, ratio, ground.friction_ratio));
            }
        }
        let value_and_error = |estimate: Estimate| [estimate.value, estimate.standard_error];
        let to_report = |(video, slide): &(String, MeasuredSlide)| SlideReport {
            video: video.clone(),
            is_head_first: slide.is_head_first,
            tilt: value_and_error(slide.tilt),
            static_friction: value_and_error(slide.static_friction),
            sliding_friction: value_and_error(slide.sliding_friction),
        };
        Self {
            slides: slides.iter().map(to_report).collect(),
            keys,
        }
    }

    fn format_text(&self) -> String {
        let mut text =
            "slides first  tilt, deg        static friction  sliding friction\n".to_owned();
        for slide in &self.slides {
            let end_name = if slide.is_head_first { "head" } else { "tail" };
            let format_pair = |[value, error]: [f64; 2], decimals: usize| {
                format!("{value:.decimals$} +- {error:.decimals$}")
            };
            let _ = writeln!(
                text,
                "{end_name:<14}{:<17}{:<17}{:<18}{}",
                format_pair(slide.tilt, 1),
                format_pair(slide.static_friction, 3),
                format_pair(slide.sliding_friction, 3),
                slide.video
            );
        }
        if self.keys.is_empty() {
            return text
                + "\nNot measured: friction (needs a video of a slide with the head downhill).\n";
        }
        let table = measured_key::format_table(&self.keys);
        let toml_lines = measured_key::format_toml_lines(&self.keys);
        let _ = write!(text, "\n{table}\n{toml_lines}");
        if self.keys.len() == 1 {
            text += "Not measured: friction_back_over_forward (needs a video of a slide with the head uphill).\n";
        }
        text
    }
}
