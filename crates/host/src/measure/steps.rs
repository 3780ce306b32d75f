//! `lizard measure steps`: prints the console commands that turn a servo in the jig.

use std::io::{self, Write};
use std::thread;
use std::time::Duration;

use lizard_robot::Robot;
use lizard_robot::servo::SERVO_NAMES;
use lizard_video::servo_commands::{COMMAND_INTERVAL, ServoCommand, list_commands};

use crate::{Failure, RobotArgs};

/// Time before the first step, while the console waits for the board, s.
const LEAD_TIME_S: f64 = 6.0;
/// Smallest slew limit for the jig, deg/s: the largest value that robot.toml allows, above the rate of any servo.
const MIN_JIG_SLEW: f64 = 1000.0;
/// Spacing of the poses that are checked along a step, deg.
const CHECK_SPACING_DEG: f64 = 1.0;

/// Print the commands that turn a servo for `lizard measure servo`, one each second
///
/// Pipe the commands into `lizard console`: the time between them matters. The servo jumps by 60 deg, so the robot must
/// stand free, or the servo must be off its link. robot.toml needs `slew = 1000.0` under [limits]: change it in a copy,
/// and flash this copy only for the measurement. The first command, `factory`, replaces the board's calibration with
/// that of robot.toml until the next reset.
#[derive(clap::Args, Debug)]
#[command(after_help = "Example:
  lizard measure steps --servo A1 --robot jig.toml | lizard console")]
pub struct StepsArgs {
    /// The servo: A1, A2, A3 or A4
    #[arg(long, value_name = "NAME", value_parser = parse_servo)]
    servo: usize,
    /// Print all commands at once, without pauses
    #[arg(long)]
    list: bool,
    #[command(flatten)]
    robot: RobotArgs,
}

/// Parses a servo's name, A1 to A4, in capitals or not. Returns its index, 0 to 3.
pub(super) fn parse_servo(text: &str) -> Result<usize, String> {
    let index = SERVO_NAMES
        .iter()
        .position(|name| name.eq_ignore_ascii_case(text));
    index.ok_or_else(|| "expected A1, A2, A3 or A4".to_owned())
}

/// Prints the commands, with pauses unless `--list` is given.
///
/// # Errors
/// Fails if the robot's slew limit is too low, if its servo cannot make all steps, or if standard output is closed.
pub fn print_steps(args: StepsArgs) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    check_slew(&robot)?;
    let mut out = io::stdout().lock();
    for (line, pause_s) in list_timed_lines(&robot, args.servo)? {
        writeln!(out, "{line}")?;
        out.flush()?;
        if !args.list {
            thread::sleep(Duration::from_secs_f64(pause_s));
        }
    }
    Ok(())
}

/// Checks that the slew limit is at least [`MIN_JIG_SLEW`], so that it does not slow a servo down.
pub(super) fn check_slew(robot: &Robot) -> Result<(), Failure> {
    let slew = robot.speed_limits().slew;
    if slew < MIN_JIG_SLEW {
        return Err(Failure::Input(format!(
            "the slew limit of robot {} is {slew} deg/s, which hides the servos' own rate: write \
             slew = {MIN_JIG_SLEW:.1} under [limits] into a copy of the file, flash the copy, and give it with --robot",
            robot.name()
        )));
    }
    Ok(())
}

/// Lists the lines for the console, each with the time until the next line, s.
fn list_timed_lines(robot: &Robot, servo: usize) -> Result<Vec<(String, f64)>, Failure> {
    let direction = find_free_direction(robot, servo)?;
    let format_pose = |sweep: f64| {
        let [a1, a2, a3, a4] =
            compute_swept_angles(robot, servo, sweep).map(|angle| format!("{angle:.2}"));
        format!("pose {a1} {a2} {a3} {a4}")
    };
    let mut lines = vec![
        ("factory".to_owned(), COMMAND_INTERVAL),
        (format_pose(0.0), LEAD_TIME_S - COMMAND_INTERVAL),
    ];
    let sign = |is_reversed: bool| {
        let is_positive = robot.servos()[servo].us_per_degree > 0.0;
        if is_positive == is_reversed { '-' } else { '+' }
    };
    let mut was_reversed = false;
    for ServoCommand { sweep, is_reversed } in list_commands(direction) {
        let line = match is_reversed == was_reversed {
            true => format_pose(sweep),
            false => format!("dir {} {}", servo + 1, sign(is_reversed)),
        };
        was_reversed = is_reversed;
        lines.push((line, COMMAND_INTERVAL));
    }
    lines.push((format_pose(0.0), 0.0));
    Ok(lines)
}

/// Returns the angles of all servos, deg: neutral, with one servo turned from neutral by `sweep`, deg.
fn compute_swept_angles(robot: &Robot, servo: usize, sweep: f64) -> [f64; 4] {
    let mut angles = robot.servos().map(|servo| servo.neutral);
    angles[servo] += sweep;
    angles
}

/// Finds the direction from neutral in which the linkage allows all steps of a servo: 1 counter-clockwise, -1
/// clockwise.
///
/// # Errors
/// Fails if neither direction is free.
pub(super) fn find_free_direction(robot: &Robot, servo: usize) -> Result<f64, Failure> {
    let is_free = |direction: &f64| {
        list_commands(*direction).iter().all(|command| {
            let ServoCommand { sweep, .. } = *command;
            let interval_count = (sweep.abs() / CHECK_SPACING_DEG).ceil().max(1.0);
            let is_path_accepted = (0..=interval_count as usize).all(|i| {
                let angles = compute_swept_angles(robot, servo, sweep * i as f64 / interval_count);
                robot.solve_if_allowed(angles).is_some()
            });
            let travel = robot.servos()[servo].travel();
            is_path_accepted && (travel.0..=travel.1).contains(&command.pulse_angle())
        })
    };
    [1.0, -1.0].into_iter().find(is_free).ok_or_else(|| {
        let name = SERVO_NAMES[servo];
        Failure::Input(format!(
            "the steps turn {name} by 30 deg, but neither direction is free: the linkage or the pulse limits of \
             robot {} prevent it",
            robot.name()
        ))
    })
}
