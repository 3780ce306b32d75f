//! `lizard gaits`: the results of checking every gait, and the predicted distance of each.

use std::io::Write;

use lizard_kinematics::Check;
use lizard_robot::{
    Assumptions, Prediction, Report, Robot, Round, Row, Sensitivity, ServoTable, servo,
};
use serde::Serialize;

use crate::shared::json;
use crate::shared::pose_args::ANGLE_NAMES;
use crate::shared::progress::Spinner;
use crate::shared::suggestion::suggestion_text;
use crate::{Failure, RobotFile};

/// Check every gait of robot.toml and predict how far it walks.
///
/// Prints for each gait: the time of a cycle, its fastest frame, the error of its table over all 65536 phases, the
/// smallest margins and the slider travel over every sample, and the displacement of one cycle by the contact model.
/// A dash means that two feet pull against two, so the model cannot decide. For each routine it prints how long one
/// round takes and how far the robot gets in it, including the transitions between its gaits. If a gait breaks a
/// limit, the program names the gait, its phase, the margin, its value and the limit, and ends with exit code 2. It
/// does the same for any other mistake in the file.
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
    /// Print instead the servo angles of one gait over a cycle as CSV, with the header
    /// seconds,theta1,theta4,theta8,theta5: frames of 20 ms at full speed, degrees in the
    /// chassis frame, as `lizard pose` reads them
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "GAIT", conflicts_with = "json")]
    trace: Option<String>,
    /// Print instead how far each gait walks on other pads (friction backward over
    /// forward), with the legs mounted differently, and on other feet
    #[arg(long, conflicts_with_all = ["json", "trace"])]
    sensitivity: bool,
    /// Print instead which assumptions change how far the gaits walk by a tenth or more, and how
    /// much: servos, joints, mass, pads, legs and feet, each over its plausible range
    #[arg(long, conflicts_with_all = ["json", "trace", "sensitivity"])]
    assumptions: bool,
    /// Print instead how much of their servos' torque-speed line the gaits use, and how far they
    /// walk, on several supplies and at two speeds
    #[arg(long, conflicts_with_all = ["json", "trace", "sensitivity", "assumptions"])]
    servos: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// Prints the table, the JSON objects or the trace that the arguments select.
///
/// # Errors
/// Fails for an invalid robot.toml, a gait that it does not have, or an output that cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let mut out = std::io::stdout().lock();
    match args.trace {
        Some(name) => out.write_all(trace_csv(&robot, &name)?.as_bytes())?,
        None if args.sensitivity => write!(out, "{}", with_spinner(|| Sensitivity::of(&robot)))?,
        None if args.assumptions => write!(out, "{}", with_spinner(|| Assumptions::of(&robot)))?,
        None if args.servos => write!(out, "{}", with_spinner(|| ServoTable::of(&robot)))?,
        None if args.json => {
            let report = with_spinner(|| Report::of(&robot));
            for row in &report.rows {
                json::write_line(&mut out, &GaitLine::new(row))?;
            }
            for round in &report.rounds {
                json::write_line(&mut out, &RoutineLine::new(round))?;
            }
        }
        None => write!(out, "{}", with_spinner(|| Report::of(&robot)))?,
    }
    Ok(out.flush()?)
}

/// Computes a table while a spinner shows the elapsed time.
fn with_spinner<T>(compute: impl FnOnce() -> T) -> T {
    let _spinner = Spinner::new("walking every gait");
    compute()
}

/// Returns the servo angles of one cycle of a gait as CSV, one row per frame, as the firmware reads them from its
/// table.
fn trace_csv(robot: &Robot, name: &str) -> Result<String, Failure> {
    let Some(gait) = robot.gait(name) else {
        let names: Vec<&str> = robot.gaits().iter().map(|gait| gait.name()).collect();
        return Err(Failure::Input(format!(
            "--trace {name}: the gaits are {}{}",
            names.join(", "),
            suggestion_text(name, names)
        )));
    };
    let mut text = format!("seconds,{}\n", ANGLE_NAMES.join(","));
    for (seconds, phase) in gait.frames() {
        let [a1, a2, a3, a4] = gait.table_angles(phase);
        text += &format!("{seconds:.2},{a1:.3},{a2:.3},{a3:.3},{a4:.3}\n");
    }
    Ok(text)
}

/// The values of a gait, under their names in `--json`.
#[derive(Serialize)]
struct GaitLine<'a> {
    gait: &'a str,
    /// Duration of one cycle, s.
    period: f64,
    /// Highest speed of a servo over one frame, deg/s.
    peak_speed: f64,
    /// The servo that has this speed, A1 to A4.
    peak_servo: &'static str,
    /// Largest error of the table over all phases, deg.
    table_error_max: f64,
    /// Root mean square of that error, deg.
    table_error_rms: f64,
    /// Smallest margin to a type-2 singularity.
    type2: LeastMargin,
    /// Smallest margin to a type-1 singularity.
    type1: LeastMargin,
    /// Smallest margin of a leg.
    leg: LeastMargin,
    /// Smallest and largest slider travel from nominal, mm.
    stroke: [f64; 2],
    /// Displacement of one cycle with ideal servos, mm and deg counter-clockwise. A value is null if the contact
    /// model cannot decide it, since two feet pull against two with equal force.
    predicted: Displacement,
    /// Largest used share of a servo's torque-speed line.
    line: f64,
    /// Displacement of one cycle with the servos of robot.toml, in the form of `predicted`.
    by_servos: Displacement,
}

/// The smallest margin of a kind over a cycle.
#[derive(Serialize)]
struct LeastMargin {
    /// As a sine.
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

/// The values of a routine, under their names in `--json`.
#[derive(Serialize)]
struct RoutineLine<'a> {
    routine: &'a str,
    /// Number of its steps.
    steps: usize,
    /// Number of rounds; null for a routine without an end.
    repeat: Option<u16>,
    /// Duration of one round that starts from standing, s.
    seconds: f64,
    /// Displacement of one round with ideal servos, in the form of [`GaitLine::predicted`].
    predicted: Displacement,
    /// Displacement of one round with the servos of robot.toml.
    by_servos: Displacement,
}

impl<'a> RoutineLine<'a> {
    fn new(round: &'a Round) -> Self {
        Self {
            routine: &round.name,
            steps: round.step_count,
            repeat: round.round_count,
            seconds: round.seconds,
            predicted: round.movement.into(),
            by_servos: round.driven_movement.into(),
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
    fn new(row: &'a Row) -> Self {
        let least_margin = |smallest: lizard_robot::LeastMargin| LeastMargin {
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
            type2: least_margin(audit.type2),
            type1: least_margin(audit.type1),
            leg: least_margin(audit.leg),
            stroke: [audit.stroke_range.0, audit.stroke_range.1],
            predicted: row.movement.into(),
            line: row.line_share,
            by_servos: row.driven_movement.into(),
        }
    }
}
