//! `lizard measure steps`: prints the console lines that turn a servo in the jig.

use std::io::{self, Write};
use std::thread;
use std::time::Duration;

use lizard_film::orders::{ORDER_INTERVAL, Order, orders};
use lizard_robot::Robot;
use lizard_robot::servo::SERVO_NAMES;

use crate::{Failure, RobotFile};

/// Time before the first step, while the console waits for the board, s.
const LEAD_TIME_S: f64 = 6.0;
/// Slew limit that the jig needs, deg/s: the largest that robot.toml allows, above the rate of any servo.
const MIN_JIG_SLEW: f64 = 1000.0;
/// Spacing of the poses that are checked along a step, deg.
const CHECK_SPACING_DEG: f64 = 1.0;

/// Print the lines that turn a servo for `lizard measure servo`, one each second
///
/// Pipe them into `lizard console`: the time between them counts. The robot must stand free, or the servo without its
/// link, because it jumps by 60 deg. The robot's file needs `slew = 1000.0` under [limits], in a copy that is flashed
/// for this trial alone, and the board's calibration is set back with `factory` until the next reset.
#[derive(clap::Args, Debug)]
#[command(after_help = "Example:
  lizard measure steps --servo A1 --robot jig.toml | lizard console")]
pub struct StepsArgs {
    /// The servo: A1, A2, A3 or A4
    #[arg(long, value_name = "NAME", value_parser = parse_servo)]
    servo: usize,
    /// Print all of them at once, to read them
    #[arg(long)]
    list: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// Parses a servo's name.
pub(super) fn parse_servo(text: &str) -> Result<usize, String> {
    let index = SERVO_NAMES
        .iter()
        .position(|name| name.eq_ignore_ascii_case(text));
    index.ok_or_else(|| "it is A1, A2, A3 or A4".to_owned())
}

/// Prints the console lines, each at its time unless `--list` is given.
///
/// # Errors
/// Fails if the robot's slew limit is too low, if its servo cannot make all steps, or if standard output is closed.
pub fn print_steps(args: StepsArgs) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    check_slew(&robot)?;
    let lines = timed_console_lines(&robot, args.servo)?;
    let mut out = io::stdout().lock();
    for (line, pause_s) in lines {
        writeln!(out, "{line}")?;
        out.flush()?;
        if !args.list {
            thread::sleep(Duration::from_secs_f64(pause_s));
        }
    }
    Ok(())
}

/// Checks that the slew limit is at least [`MIN_JIG_SLEW`], so that the limit does not slow a servo down.
pub(super) fn check_slew(robot: &Robot) -> Result<(), Failure> {
    let slew = robot.speed_limits().slew;
    if slew < MIN_JIG_SLEW {
        return Err(Failure::Input(format!(
            "robot {} changes its pulses by {slew} deg/s at most, so its servos cannot show their own rate: write \
             slew = {MIN_JIG_SLEW:.1} under [limits] into a copy, flash that one, and give it with --robot",
            robot.name()
        )));
    }
    Ok(())
}

/// The lines for the console, each with the time until the next one, s.
fn timed_console_lines(robot: &Robot, servo: usize) -> Result<Vec<(String, f64)>, Failure> {
    let direction = free_direction(robot, servo)?;
    let pose_at = |sweep: f64| pose_line(robot, servo, sweep);
    let mut lines = vec![
        ("factory".to_owned(), ORDER_INTERVAL),
        (pose_at(0.0), LEAD_TIME_S - ORDER_INTERVAL),
    ];
    let sign_of = |is_reversed: bool| {
        let is_positive = robot.servos()[servo].us_per_degree > 0.0;
        if is_positive == is_reversed { '-' } else { '+' }
    };
    let mut was_reversed = false;
    for Order { sweep, is_reversed } in orders(direction) {
        let line = match is_reversed == was_reversed {
            true => pose_at(sweep),
            false => format!("dir {} {}", servo + 1, sign_of(is_reversed)),
        };
        was_reversed = is_reversed;
        lines.push((line, ORDER_INTERVAL));
    }
    lines.push((pose_at(0.0), 0.0));
    Ok(lines)
}

/// The angles of all servos, deg: neutral, but with one servo turned from neutral by `sweep`, deg.
fn swept_angles(robot: &Robot, servo: usize, sweep: f64) -> [f64; 4] {
    let mut angles = robot.servos().map(|servo| servo.neutral);
    angles[servo] += sweep;
    angles
}

/// The console line for the pose with one servo turned from neutral by `sweep`, deg.
fn pose_line(robot: &Robot, servo: usize, sweep: f64) -> String {
    let [a1, a2, a3, a4] = swept_angles(robot, servo, sweep).map(|angle| format!("{angle:.2}"));
    format!("pose {a1} {a2} {a3} {a4}")
}

/// The direction from neutral in which the linkage allows all steps of a servo: 1 counter-clockwise, -1 clockwise.
///
/// # Errors
/// Fails if neither direction is free.
pub(super) fn free_direction(robot: &Robot, servo: usize) -> Result<f64, Failure> {
    let is_free = |direction: &f64| {
        orders(*direction).iter().all(|order| {
            let Order { sweep, .. } = *order;
            let interval_count = (sweep.abs() / CHECK_SPACING_DEG).ceil().max(1.0);
            let is_path_accepted = (0..=interval_count as usize).all(|i| {
                let angles = swept_angles(robot, servo, sweep * i as f64 / interval_count);
                robot.solve_if_allowed(angles).is_some()
            });
            let travel = robot.servos()[servo].travel();
            is_path_accepted && (travel.0..=travel.1).contains(&order.pulse_angle())
        })
    };
    [1.0, -1.0].into_iter().find(is_free).ok_or_else(|| {
        let name = SERVO_NAMES[servo];
        Failure::Input(format!(
            "the linkage of robot {} lets {name} turn to neither side by the steps' 30 deg, or its pulses do",
            robot.name()
        ))
    })
}
