//! `lizard twin`: runs the real firmware on the simulated UNO, moves a simulated robot with its pulses, and reports the
//! robot's path.

pub mod replay;
pub mod report;
mod robust;

use std::io::{self, Write};
use std::path::PathBuf;

use lizard_robot::{OPEN_INPUTS_NOTE, Robot, Routine, RoutineRow, to_command};
use lizard_twin::ServoModel;
use simulated_uno::{Fidelity, Image, State, Uno};

use crate::shared::number::whole_number_parser;
use crate::shared::progress::create_spinner;
use crate::shared::robot_args::find_moving_gait;
use crate::shared::{firmware, json};
use crate::simulate::sim::script::{Script, Step};
use crate::simulate::sim::session::Recording;
use crate::simulate::sim::{gait_choice, play_with_progress, read_script, spans};
use crate::{Failure, RobotArgs};
use replay::Replay;

/// Simulate the robot with the firmware's pulses: servos, linkage, springs, feet, its path
///
/// Runs the firmware on the simulated UNO. Its pulses drive simulated servos, which turn the
/// linkage; springs pull the legs, and the contact model computes the body's displacement.
/// Without a script, the robot walks three cycles of every gait in robot.toml that moves it.
/// The table compares each gait's last complete cycle with the prediction of `lizard gaits`.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard twin
  lizard twin dance.txt
  lizard twin --gait crawl --robust 200

A script is a file with lines `<ms since power-on> <command>`.")]
pub struct Args {
    /// A file of commands and their times, as for `lizard sim` [default: every gait
    /// that moves the robot]
    #[arg(value_name = "SCRIPT")]
    script: Option<PathBuf>,
    /// Run only this gait of robot.toml, or one round of this routine
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "NAME", conflicts_with = "script")]
    gait: Option<String>,
    /// The firmware, an ELF that contains this robot [default: the built-in firmware]
    #[arg(long, value_name = "FILE")]
    elf: Option<PathBuf>,
    /// The servo model
    #[arg(long, value_enum, default_value_t)]
    servo: ServoArg,
    /// Print one JSON object per line, one for each command
    #[arg(long)]
    json: bool,
    /// Then simulate each gait N more times, at least 2, with random friction, loads, mounting,
    /// hips, feet, springs and play, and print the spread of the displacements and how close
    /// the servos come to the limit of their torque at each speed
    #[arg(long = "robust", value_name = "N", value_parser = whole_number_parser::<u32>(2, 100_000))]
    variation_count: Option<u32>,
    #[command(flatten)]
    robot: RobotArgs,
}

/// The model of the servos, as named on the command line.
#[derive(clap::ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
enum ServoArg {
    /// Servos with the torque, rate, spin-up time and dead band from `[servo]` in robot.toml
    #[default]
    Own,
    /// Servos that follow their pulses at once under any load
    Ideal,
}

/// Runs the firmware, simulates the robot and prints the report.
///
/// # Errors
/// Fails if robot.toml or the script is invalid, if the firmware is missing, contains another robot or crashes, if the
/// gait is unknown, or if the output cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let script = choose_script(&args, &robot)?;
    let mut image = firmware::select_firmware(args.elf.as_deref(), &args.robot, &robot)?.image;
    let routine = args.gait.as_deref().and_then(|name| robot.routine(name));
    let has_inputs = routine.is_some_and(Routine::has_inputs);
    if has_inputs {
        image = firmware::remove_contacts(image, &robot);
    }
    let recording = record(image, &robot, &script)?;
    let model = match args.servo {
        ServoArg::Own => ServoModel::for_robot(&robot),
        ServoArg::Ideal => ServoModel::Ideal,
    };
    let spans = spans::list_command_spans(&script, &recording.answers);
    let mut steps = script.steps.iter().zip(&recording.answers);
    let changes_speed =
        steps.any(|(step, answer)| step.command.starts_with("speed") && !spans::is_refused(answer));
    let spinner = create_spinner("simulating every frame");
    let replay = Replay::simulate(&robot, recording.frames, spans, model);
    let rows = report::compute_reports(&robot, &replay, model, changes_speed);
    drop(spinner);

    let mut out = io::stdout().lock();
    if args.json {
        for row in &rows {
            json::write_line(&mut out, row)?;
        }
    } else {
        report::print_table(&rows, &mut out)?;
        if has_inputs {
            write!(out, "\n{OPEN_INPUTS_NOTE}")?;
        }
    }
    if let Some(variation_count) = args.variation_count {
        robust::run(&robot, &replay, model, variation_count, args.json, &mut out)?;
    }
    Ok(out.flush()?)
}

/// Plays the script on a simulated UNO, with a progress bar but without printing the dialogue.
///
/// # Errors
/// Fails if the firmware stops before the end of the script.
pub(crate) fn record(image: Image, robot: &Robot, script: &Script) -> Result<Recording, Failure> {
    let mut uno = Uno::with_image(image, Fidelity::DataSheet);
    let recording = play_with_progress(&mut uno, robot, script, |_| Ok(()))?;
    match recording.state {
        State::Alive => Ok(recording),
        _ => Err(Failure::Operation(
            "the firmware stopped; `lizard sim` shows the reason".to_owned(),
        )),
    }
}

/// Returns the script that the command-line options select.
fn choose_script(args: &Args, robot: &Robot) -> Result<Script, Failure> {
    if let Some(path) = &args.script {
        return read_script(path);
    }
    Ok(match &args.gait {
        None => build_walk_script(robot, &gait_choice::list_moving_gaits(robot)),
        Some(name) => match robot.routine(name) {
            Some(routine) => build_round_script(robot, routine),
            None => build_walk_script(robot, &[find_moving_gait(robot, name)?.name()]),
        },
    })
}

/// Standing time before and after the motion of a built-in script, and time for the move to a gait's first pose, ms.
const STAND_MS: u64 = 1000;

/// Builds a script for one round of a routine. The round starts after a second of standing, and the script ends two
/// seconds after the round.
fn build_round_script(robot: &Robot, routine: &Routine) -> Script {
    let round = RoutineRow::simulate(robot, routine);
    let round_end_ms = STAND_MS + (1000.0 * round.seconds).ceil() as u64;
    let steps = vec![
        Step::new(STAND_MS, format!("{} 1", routine.command())),
        Step::new(round_end_ms + STAND_MS, "stop"),
    ];
    Script::new(steps, round_end_ms + 2 * STAND_MS)
}

/// Builds a script that runs three cycles of each gait, after a second in which the robot moves to the gait's first
/// pose. The robot stands for a second before the first gait and after the last gait.
pub(crate) fn build_walk_script(robot: &Robot, gaits: &[&str]) -> Script {
    const CYCLES_PER_GAIT: f64 = 3.0;
    let mut start_ms = STAND_MS;
    let mut steps = Vec::new();
    for name in gaits {
        steps.push(Step::new(start_ms, to_command(name)));
        let period = robot.gait(name).map_or(1.0, |gait| gait.period());
        start_ms += STAND_MS + (1000.0 * CYCLES_PER_GAIT * period).ceil() as u64;
    }
    steps.push(Step::new(start_ms, "stop"));
    Script::new(steps, start_ms + STAND_MS)
}
