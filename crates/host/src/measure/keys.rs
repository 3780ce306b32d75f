//! `lizard measure keys`: identifies keys of robot.toml from measured movements of gaits.

use std::path::{Path, PathBuf};

use lizard_identify::{IdentifyError, MeasuredMovement, identify};
use lizard_robot::Robot;
use rayon::prelude::*;
use serde::Deserialize;

use super::keys_report::{KeysReport, format_report};
use super::measured_key::is_earlier_output;
use crate::shared::files;
use crate::shared::json;
use crate::shared::progress::create_spinner;
use crate::{Failure, RobotArgs};

/// Largest difference between a gait's cycle times in two robot.toml files that count as the same robot, s.
const MAX_PERIOD_DIFFERENCE_S: f64 = 0.005;

/// Identify keys of robot.toml from measured gaits
///
/// Each FILE is the output of `lizard measure --json` for one or several gaits; walk, trot, crawl, back, left, right
/// and the arcs contribute most. Finds the play of the legs, their mounting, the centre of mass, a foot that is too
/// long, and the friction, by least squares. A key stays unchanged if these gaits do not determine it, or if it is
/// right within two standard errors. Writes a new robot.toml with a comment at each changed line, and prints the
/// predictions before and after.
#[derive(clap::Args, Debug)]
#[command(after_help = "Example:
  lizard measure video.mp4 --json > video.json
  lizard measure keys video.json --output measured.toml
  lizard gaits --robot measured.toml
  lizard tune --robot measured.toml")]
pub struct KeysArgs {
    /// Files with the output of `lizard measure --json`
    #[arg(value_name = "FILE", required = true)]
    paths: Vec<PathBuf>,
    /// Output file for the new robot.toml; replaces only an earlier output that nobody has edited
    #[arg(long, short, value_name = "FILE", default_value = "out/measured.toml")]
    output: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotArgs,
}

/// The output of `lizard measure --json`, with only the fields that identification needs.
#[derive(Deserialize)]
struct MeasureOutput {
    gaits: Vec<MeasuredGait>,
}

/// The measured movement of a gait in a cycle.
#[derive(Deserialize)]
struct MeasuredGait {
    gait: String,
    /// Pace of the gait, percent of its full pace.
    #[serde(rename = "speed")]
    pace_percent: f64,
    /// Cycle time in the robot.toml of the measurement, s; `None` if that file does not have the gait.
    #[serde(rename = "period_expected")]
    expected_period: Option<f64>,
    forward: Component,
    left: Component,
    turn: Component,
}

/// A component of a movement: its mean and the standard error of the mean, mm or deg.
#[derive(Deserialize)]
struct Component {
    mean: f64,
    error: f64,
}

/// Finds the keys, prints them, and writes the new robot.toml.
///
/// # Errors
/// Fails if a file is not from `lizard measure` or is from another robot, if the model cannot predict or fit the gaits,
/// if the output would replace an input or a user's robot, or if it cannot be written.
pub fn identify_keys(args: KeysArgs) -> Result<(), Failure> {
    let old_text = args.robot.text()?;
    let robot = args.robot.load()?;
    let mut movements = Vec::new();
    for path in &args.paths {
        movements.append(&mut read_movements(path, &robot)?);
    }
    let is_own_output = |text: &str| is_earlier_output(text, old_text);
    files::check_replaceable_robot(&args.output, is_own_output)?;
    let spinner = create_spinner("simulating the gaits");
    let to_failure = |error: IdentifyError| Failure::Input(error.to_string());
    let identified = identify(&robot, &movements, &|count, walk| {
        (0..count).into_par_iter().map(walk).collect()
    })
    .map_err(to_failure)?;
    drop(spinner);
    let has_changes = identified.changed_keys().next().is_some();
    if has_changes {
        let new_text = identified.updated_robot_toml(old_text);
        let new_text = new_text.map_err(to_failure)?;
        files::write_robot(&args.output, new_text.as_bytes(), is_own_output)?;
    }
    let output_path = has_changes.then_some(args.output.as_path());
    let report = KeysReport::new(&identified, output_path);
    json::print_json_or_text(args.json, &report, || {
        format_report(&identified, output_path)
    })
}

/// Reads the measured gaits of a file.
fn read_movements(path: &Path, robot: &Robot) -> Result<Vec<MeasuredMovement>, Failure> {
    let to_failure = |problem: String| Failure::Input(format!("{}: {problem}", path.display()));
    let output: MeasureOutput =
        serde_json::from_str(&files::read_text(path)?).map_err(|error| {
            to_failure(format!(
                "expected the output of `lizard measure --json`: {error}"
            ))
        })?;
    let gaits = output.gaits.iter();
    let movements = gaits.map(|measured| to_movement(measured, robot));
    movements.collect::<Result<_, _>>().map_err(to_failure)
}

/// Converts a measured gait to its movement per cycle.
///
/// # Errors
/// Fails if the gait was measured with a robot.toml in which it has another cycle time.
fn to_movement(measured: &MeasuredGait, robot: &Robot) -> Result<MeasuredMovement, String> {
    let gait = &measured.gait;
    let pace = measured.pace_percent / 100.0;
    let robot_period = robot.gait(gait).map(|gait| gait.period() / pace);
    if let (Some(robot_period), Some(measurement_period)) = (robot_period, measured.expected_period)
        && (robot_period - measurement_period).abs() > MAX_PERIOD_DIFFERENCE_S
    {
        return Err(format!(
            "a cycle of `{gait}` takes {robot_period:.2} s in this robot.toml, but {measurement_period:.2} s in \
             the robot.toml of the measurement: give the same file with --robot"
        ));
    }
    let components = [&measured.forward, &measured.left, &measured.turn];
    Ok(MeasuredMovement {
        gait: gait.clone(),
        pace,
        mean: components.map(|component| component.mean),
        error: components.map(|component| component.error),
    })
}
