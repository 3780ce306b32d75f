//! `lizard measure keys`: identifies keys of robot.toml from the measured movements per cycle of gaits.

use std::path::{Path, PathBuf};

use lizard_identify::{IdentifyError, MeasuredMovement, identify};
use lizard_robot::Robot;
use rayon::prelude::*;
use serde::Deserialize;

use super::keys_report::{KeysReport, report_text};
use crate::shared::files;
use crate::shared::json;
use crate::shared::progress::Spinner;
use crate::{Failure, RobotFile};

/// Largest difference between a gait's cycle times in two robot.toml files that still count as the same robot, s.
const MAX_PERIOD_DIFFERENCE_S: f64 = 0.005;

/// Find the keys of robot.toml with which the model goes as far as the robot did
///
/// Each FILE has what `lizard measure --json` printed, for one gait or more; walk, trot, crawl, back, left, right
/// and the arcs tell most. Finds the play of the legs, their mounting, mass centre, a foot too long, and the friction,
/// by least squares. A key that these gaits do not tell, or that is right within two standard errors, stays as it is.
/// Writes a new robot.toml with a comment at each changed line, and prints the predictions before and after.
#[derive(clap::Args, Debug)]
#[command(after_help = "Example:
  lizard measure film.mp4 --json > film.json
  lizard measure keys film.json --output measured.toml
  lizard gaits --robot measured.toml
  lizard tune --robot measured.toml")]
pub struct KeysArgs {
    /// Files with what `lizard measure --json` printed
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// The file for the new robot.toml
    #[arg(long, short, value_name = "FILE", default_value = "out/measured.toml")]
    output: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// The fields of the output of `lizard measure --json` that identification needs.
#[derive(Deserialize)]
struct MeasureOutput {
    gaits: Vec<MeasuredGait>,
}

/// The measured movement of a gait in a cycle.
#[derive(Deserialize)]
struct MeasuredGait {
    gait: String,
    /// Speed, percent.
    speed: f64,
    /// Cycle time in the robot.toml with which the gait was measured, s; `None` if that file does not have the gait.
    period_expected: Option<f64>,
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
/// Fails if a file is not from `lizard measure` or is from another robot, if the gaits determine no key, or if the
/// output would replace an input or a robot, or cannot be written.
pub fn find_keys(args: KeysArgs) -> Result<(), Failure> {
    let old_text = args.robot.text()?;
    let robot = args.robot.load()?;
    let mut movements = Vec::new();
    for file in &args.files {
        movements.append(&mut read_movements(file, &robot)?);
    }
    files::check_replaceable(&args.output)?;
    let spinner = Spinner::new("simulating the gaits");
    let failure_of = |error: IdentifyError| Failure::Input(error.to_string());
    let identified = identify(&robot, &movements, &|count, walk| {
        (0..count).into_par_iter().map(walk).collect()
    })
    .map_err(failure_of)?;
    drop(spinner);
    let has_changes = identified.changed_keys().next().is_some();
    if has_changes {
        let new_text = identified
            .updated_robot_toml(&old_text)
            .map_err(failure_of)?;
        files::write(&args.output, new_text.as_bytes())?;
    }
    let written_path = has_changes.then_some(args.output.as_path());
    let report = KeysReport::new(&identified, written_path);
    json::print_json_or_text(args.json, &report, || {
        report_text(&identified, written_path)
    })
}

/// Reads the measured gaits of a file.
fn read_movements(path: &Path, robot: &Robot) -> Result<Vec<MeasuredMovement>, Failure> {
    let failure_of = |problem: String| Failure::Input(format!("{}: {problem}", path.display()));
    let output: MeasureOutput =
        serde_json::from_str(&files::read_text(path)?).map_err(|error| {
            failure_of(format!(
                "this is not what `lizard measure --json` prints: {error}"
            ))
        })?;
    let movements = output
        .gaits
        .iter()
        .map(|measured| measured_movement(measured, robot));
    movements.collect::<Result<_, _>>().map_err(failure_of)
}

/// The movement per cycle of a measured gait.
///
/// # Errors
/// Fails if the gait was measured with a robot.toml that gives it another cycle time.
fn measured_movement(measured: &MeasuredGait, robot: &Robot) -> Result<MeasuredMovement, String> {
    let MeasuredGait { gait, speed, .. } = measured;
    let pace = speed / 100.0;
    let robot_period = robot.gait(gait).map(|gait| gait.period() / pace);
    if let (Some(robot_period), Some(measurement_period)) = (robot_period, measured.period_expected)
        && (robot_period - measurement_period).abs() > MAX_PERIOD_DIFFERENCE_S
    {
        return Err(format!(
            "a cycle of `{gait}` takes {robot_period:.2} s by this robot.toml, but took {measurement_period:.2} s by that of the measurement; \
             give the same one with --robot"
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
