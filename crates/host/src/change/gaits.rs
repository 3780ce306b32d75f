//! `lizard gaits`: checks every gait and predicts the robot's displacement with each of them.

use std::io::Write;

use lizard_kinematics::Check;
use lizard_robot::{
    Assumptions, GaitRow, Prediction, Report, Robot, RoutineRow, Sensitivity, ServoTable, servo,
};
use serde::Serialize;

use crate::shared::json;
use crate::shared::pose_args::ANGLE_NAMES;
use crate::shared::progress::Spinner;
use crate::shared::suggestion::format_suggestion;
use crate::{Failure, RobotFile};

/// Check every gait in robot.toml and predict how far the robot walks with it.
///
/// For each gait, prints the duration of a cycle, the highest servo speed, the table error over all 65536 phases, the
/// smallest margins and the slider travel, and the displacement per cycle according to the contact model. A dash
/// means that the model cannot decide: two feet pull with equal force against the other two. For each routine, prints
/// the duration and the displacement of one round, including the transitions between its gaits. If a gait violates a
/// limit, reports the gait, its phase, the margin, its value and the limit, and exits with code 2. Any other error in
/// the file also gives exit code 2.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lizard gaits
  lizard gaits --robot my/robot.toml --json
  lizard gaits --servos
  lizard gaits --assumptions
  lizard gaits --trace walk > walk.csv
  lizard gaits --trace walk | lizard pose")]
pub struct Args {
    /// Print one JSON object per line, one for each gait and each routine
    #[arg(long)]
    json: bool,
    /// Instead, print one cycle of a gait's servo angles as CSV, with the header
    /// seconds,theta1,theta4,theta8,theta5: one row per 20 ms at full speed, degrees in the
    /// chassis frame, as `lizard pose` reads them
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "GAIT", conflicts_with = "json")]
    trace: Option<String>,
    /// Instead, print each gait's displacement with other pads (ratio of backward to forward
    /// friction), other leg mountings and other feet
    #[arg(long, conflicts_with_all = ["json", "trace"])]
    sensitivity: bool,
    /// Instead, print the assumptions that change a gait's displacement by 10 % or more, and the
    /// change: servos, joints, mass, pads, legs and feet, each over its plausible range
    #[arg(long, conflicts_with_all = ["json", "trace", "sensitivity"])]
    assumptions: bool,
    /// Instead, print each gait's utilisation of the servos' torque-speed line, and its
    /// displacement, on several supplies and at two speeds
    #[arg(long, conflicts_with_all = ["json", "trace", "sensitivity", "assumptions"])]
    servos: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// Prints the table, the JSON objects or the trace that the arguments select.
///
/// # Errors
/// Fails for an invalid robot.toml, an unknown gait name, or an output that cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let mut out = std::io::stdout().lock();
    match args.trace {
        Some(name) => out.write_all(format_trace_csv(&robot, &name)?.as_bytes())?,
        None if args.sensitivity => {
            write!(out, "{}", with_spinner(|| Sensitivity::compute(&robot)))?
        }
        None if args.assumptions => {
            write!(out, "{}", with_spinner(|| Assumptions::compute(&robot)))?
        }
        None if args.servos => write!(out, "{}", with_spinner(|| ServoTable::compute(&robot)))?,
        None if args.json => {
            let report = with_spinner(|| Report::compute(&robot));
            for row in &report.rows {
                json::write_line(&mut out, &GaitLine::new(row))?;
            }
            for round in &report.routines {
                json::write_line(&mut out, &RoutineLine::new(round))?;
            }
        }
        None => write!(out, "{}", with_spinner(|| Report::compute(&robot)))?,
    }
    Ok(out.flush()?)
}

/// Computes a table while a spinner shows the elapsed time.
fn with_spinner<T>(compute: impl FnOnce() -> T) -> T {
    let _spinner = Spinner::new("simulating every gait");
    compute()
}

/// Returns the servo angles of one cycle of a gait as CSV, one row per frame, as the firmware reads them from its
/// table.
fn format_trace_csv(robot: &Robot, name: &str) -> Result<String, Failure> {
    let Some(gait) = robot.gait(name) else {
        let names: Vec<&str> = robot.gaits().iter().map(|gait| gait.name()).collect();
        return Err(Failure::Input(format!(
            "--trace {name}: unknown gait; allowed values: {}{}",
            names.join(", "),
            format_suggestion(name, names)
        )));
    };
    let mut text = format!("seconds,{}\n", ANGLE_NAMES.join(","));
    for (seconds, phase) in gait.frames() {
        let [a1, a2, a3, a4] = gait.table_angles(phase);
        text += &format!("{seconds:.2},{a1:.3},{a2:.3},{a3:.3},{a4:.3}\n");
    }
    Ok(text)
}

/// One gait in the `--json` output; the field names are the JSON keys.
#[derive(Serialize)]
struct GaitLine<'a> {
    gait: &'a str,
    /// Duration of one cycle, s.
    period: f64,
    /// Highest servo speed between two frames, deg/s.
    peak_speed: f64,
    /// Name of the servo with the highest speed, A1 to A4.
    peak_servo: &'static str,
    /// Largest error of the table over all phases, deg.
    table_error_max: f64,
    /// Root mean square error of the table, deg.
    table_error_rms: f64,
    /// Smallest margin to a type-2 singularity.
    type2: LeastMargin,
    /// Smallest margin to a type-1 singularity.
    type1: LeastMargin,
    /// Smallest margin of a leg.
    leg: LeastMargin,
    /// Smallest and largest slider travel relative to nominal, mm.
    stroke: [f64; 2],
    /// Displacement of one cycle with ideal servos. A value is null if the contact model cannot decide because two
    /// feet pull with equal force against the other two.
    predicted: Displacement,
    /// Highest utilisation of the torque-speed line by a servo; 1 is the limit.
    line: f64,
    /// Displacement of one cycle with the servos from robot.toml.
    by_servos: Displacement,
}

/// The smallest margin of one kind over a cycle.
#[derive(Serialize)]
struct LeastMargin {
    /// The margin, a sine.
    margin: f64,
    /// The name of the check that has this margin.
    what: &'static str,
    /// The phase at which it occurs, in cycles from 0 to 1.
    phase: f64,
}

/// A predicted displacement of the robot: mm forward, mm to the left, and deg counter-clockwise.
#[derive(Serialize)]
struct Displacement {
    forward: Option<f64>,
    left: Option<f64>,
    turn: Option<f64>,
}

/// One routine in the `--json` output; the field names are the JSON keys.
#[derive(Serialize)]
struct RoutineLine<'a> {
    routine: &'a str,
    /// Number of steps.
    steps: usize,
    /// Number of rounds; null for a routine that repeats forever.
    repeat: Option<u16>,
    /// Duration of one round that starts from standing, s.
    seconds: f64,
    /// Displacement of one round with ideal servos; null as in [`GaitLine::predicted`].
    predicted: Displacement,
    /// Displacement of one round with the servos from robot.toml.
    by_servos: Displacement,
}

impl<'a> RoutineLine<'a> {
    fn new(round: &'a RoutineRow) -> Self {
        Self {
            routine: &round.name,
            steps: round.step_count,
            repeat: round.round_count,
            seconds: round.seconds,
            predicted: round.movement.into(),
            by_servos: round.movement_with_servos.into(),
        }
    }
}

impl From<Prediction> for Displacement {
    fn from(prediction: Prediction) -> Self {
        Self {
            forward: prediction.forward,
            left: prediction.left,
            turn: prediction.turn,
        }
    }
}

impl<'a> GaitLine<'a> {
    fn new(row: &'a GaitRow) -> Self {
        let to_json = |smallest: lizard_robot::LeastMargin| LeastMargin {
            margin: smallest.value,
            what: Check::name(smallest.check),
            phase: smallest.phase,
        };
        let audit = &row.audit;
        Self {
            gait: &row.name,
            period: row.period,
            peak_speed: audit.peak_speed.speed,
            peak_servo: servo::SERVO_NAMES[audit.peak_speed.servo],
            table_error_max: row.table_error.max,
            table_error_rms: row.table_error.rms,
            type2: to_json(audit.type2),
            type1: to_json(audit.type1),
            leg: to_json(audit.leg),
            stroke: [audit.stroke_range.0, audit.stroke_range.1],
            predicted: row.movement.into(),
            line: row.utilisation,
            by_servos: row.movement_with_servos.into(),
        }
    }
}
