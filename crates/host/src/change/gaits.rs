//! `lizard gaits`: checks every gait and predicts the robot's displacement with each of them.

use std::io::Write;

use lizard_kinematics::Check;
use lizard_robot::{
    Assumptions, GaitRow, Report, Robot, RoutineRow, Sensitivity, ServoTable, servo,
};
use serde::Serialize;

use crate::shared::displacement::Displacement;
use crate::shared::json;
use crate::shared::pose_args::ANGLE_NAMES;
use crate::shared::progress::create_spinner;
use crate::shared::robot_args::unknown_gait_failure;
use crate::{Failure, RobotArgs};

/// Check every gait in robot.toml and predict how far the robot walks with it.
///
/// For each gait, prints the duration of a cycle, the highest servo speed, the largest error of the gait's table in the
/// firmware, the smallest margins and the slider travel, and the displacement per cycle according to the contact model.
/// A dash means that the model cannot decide: two feet pull with equal force against the other two. For each routine,
/// prints the duration and the displacement of one round, including the transitions between its gaits. If a gait
/// violates a limit, reports the gait, its phase, the margin, its value and the limit, and exits with code 2. Any other
/// error in the file also gives exit code 2.
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
    /// Instead, print the assumptions (about servos, joints, mass, pads, legs and feet) whose
    /// plausible ranges change a gait's displacement by 10 % or more, and by how much
    #[arg(long, conflicts_with_all = ["json", "trace", "sensitivity"])]
    assumptions: bool,
    /// Instead, print how close each gait comes to the servos' limit of torque at their speed
    /// (1: at the limit), and its displacement, on several supplies and at two speeds
    #[arg(long, conflicts_with_all = ["json", "trace", "sensitivity", "assumptions"])]
    servos: bool,
    #[command(flatten)]
    robot: RobotArgs,
}

/// Prints what the arguments select.
///
/// # Errors
/// Fails if robot.toml is invalid, if it has no gait of the given name, or if the output cannot be written.
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
            for row in &report.gait_rows {
                json::write_line(&mut out, &GaitLine::new(row))?;
            }
            for routine in &report.routine_rows {
                json::write_line(&mut out, &RoutineLine::new(routine))?;
            }
        }
        None => write!(out, "{}", with_spinner(|| Report::compute(&robot)))?,
    }
    Ok(out.flush()?)
}

/// Computes a table while a spinner shows the elapsed time.
fn with_spinner<T>(compute: impl FnOnce() -> T) -> T {
    let _spinner = create_spinner("simulating every gait");
    compute()
}

/// Returns the servo angles of one cycle of a gait as CSV, one row per frame, as the firmware reads them from its
/// table.
fn format_trace_csv(robot: &Robot, name: &str) -> Result<String, Failure> {
    let gait = robot.gait(name).ok_or_else(|| {
        let problem = format!("--trace {name}: unknown gait");
        unknown_gait_failure(&problem, name, robot.gaits().iter())
    })?;
    let mut text = format!("seconds,{}\n", ANGLE_NAMES.join(","));
    for (seconds, phase) in gait.frames() {
        let [a1, a2, a3, a4] = gait.table_angles(phase);
        text += &format!("{seconds:.2},{a1:.3},{a2:.3},{a3:.3},{a4:.3}\n");
    }
    Ok(text)
}

/// One gait in the `--json` output; the serialized field names are the JSON keys.
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
    type2: MinMargin,
    /// Smallest margin to a type-1 singularity.
    type1: MinMargin,
    /// Smallest margin of a leg.
    leg: MinMargin,
    /// Smallest and largest slider travel relative to nominal, mm.
    stroke: [f64; 2],
    /// Displacement of one cycle with ideal servos.
    #[serde(rename = "predicted")]
    ideal_displacement: Displacement,
    /// Highest utilisation of the torque-speed line by a servo; 1 is the limit.
    #[serde(rename = "line")]
    utilisation: f64,
    /// Displacement of one cycle with the servos from robot.toml.
    #[serde(rename = "by_servos")]
    displacement: Displacement,
}

/// The smallest margin of one kind over a cycle.
#[derive(Serialize)]
struct MinMargin {
    /// The margin, a sine.
    #[serde(rename = "margin")]
    value: f64,
    /// The name of the check that has this margin.
    #[serde(rename = "what")]
    check: &'static str,
    /// The phase at which it occurs, in cycles from 0 to 1.
    phase: f64,
}

/// One routine in the `--json` output; the serialized field names are the JSON keys.
#[derive(Serialize)]
struct RoutineLine<'a> {
    routine: &'a str,
    #[serde(rename = "steps")]
    step_count: usize,
    /// Null for a routine that repeats forever.
    #[serde(rename = "repeat")]
    round_count: Option<u16>,
    /// Duration of one round that starts from standing, s.
    seconds: f64,
    /// Displacement of one round with ideal servos.
    #[serde(rename = "predicted")]
    ideal_displacement: Displacement,
    /// Displacement of one round with the servos from robot.toml.
    #[serde(rename = "by_servos")]
    displacement: Displacement,
}

impl<'a> RoutineLine<'a> {
    fn new(routine: &'a RoutineRow) -> Self {
        Self {
            routine: &routine.name,
            step_count: routine.step_count,
            round_count: routine.round_count,
            seconds: routine.seconds,
            ideal_displacement: routine.movement.into(),
            displacement: routine.movement_with_servos.into(),
        }
    }
}

impl<'a> GaitLine<'a> {
    fn new(row: &'a GaitRow) -> Self {
        let to_min_margin = |margin: lizard_robot::MinMargin| MinMargin {
            value: margin.value,
            check: Check::name(margin.check),
            phase: margin.phase,
        };
        let audit = &row.audit;
        Self {
            gait: &row.name,
            period: row.period,
            peak_speed: audit.peak_speed.speed,
            peak_servo: servo::SERVO_NAMES[audit.peak_speed.servo],
            table_error_max: row.table_error.max,
            table_error_rms: row.table_error.rms,
            type2: to_min_margin(audit.type2),
            type1: to_min_margin(audit.type1),
            leg: to_min_margin(audit.leg),
            stroke: audit.stroke_range.into(),
            ideal_displacement: row.movement.into(),
            utilisation: row.utilisation,
            displacement: row.movement_with_servos.into(),
        }
    }
}
