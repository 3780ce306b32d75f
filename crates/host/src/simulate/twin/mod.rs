//! `lizard twin`: runs the real firmware on the simulated UNO, moves a simulated robot by its pulses, and reports how
//! the robot walks.

pub mod replay;
pub mod report;
mod robust;

use std::io::{self, Write};
use std::path::PathBuf;

use lizard_robot::{CheckedGait, Robot, Round, Routine, WITHOUT_CONTACTS_NOTE, command_of};
use lizard_twin::ServoModel;
use simulated_uno::{Fidelity, State, Uno};

use crate::shared::firmware;
use crate::shared::progress::Spinner;
use crate::shared::suggestion::suggestion_text;
use crate::simulate::sim::script::{Script, Step};
use crate::simulate::sim::session::{self, Event, Recording};
use crate::simulate::sim::{frame, read_script, spans, supplies, time_progress_bar, tour};
use crate::{Failure, RobotFile};
use replay::Replay;
use report::Report;

/// Let the firmware walk: servos, linkage, springs, feet, the path over the floor
///
/// Runs the image on the simulated UNO and gives its pulses to servos that turn the
/// linkage; springs pull the legs, and the contact model computes how the body moves.
/// Without a script, every gait of robot.toml walks for some cycles. The table compares
/// each gait's last complete cycle with the prediction of `lizard gaits`.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard twin
  lizard twin dance.txt
  lizard twin --gait crawl --robust 200

A script is a file of lines `<ms since power-on> <command>`.")]
pub struct Args {
    /// A file of commands and their times, as for `lizard sim` [default: every gait]
    #[arg(value_name = "SCRIPT")]
    script: Option<PathBuf>,
    /// Walk one gait of robot.toml, or one round of a routine
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "NAME", conflicts_with = "script")]
    gait: Option<String>,
    /// The firmware: an ELF that has this robot in it [default: the one inside this
    /// program]
    #[arg(long, value_name = "FILE")]
    elf: Option<PathBuf>,
    /// The model of the servos
    #[arg(long, value_enum, default_value_t)]
    servo: ServoArg,
    /// Print one JSON object per line, one for each command
    #[arg(long)]
    json: bool,
    /// Then walk each gait N more times with random friction, loads, mounting, hips,
    /// feet, springs and play, and print the spread of the distances, and how much of their
    /// servos' torque-speed line the gaits use
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=100_000))]
    robust: Option<u32>,
    #[command(flatten)]
    robot: RobotFile,
}

/// The model of the servos, as named on the command line.
#[derive(clap::ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
enum ServoArg {
    /// With the torque, the rate, the rotor and the dead band of `[servo]` in robot.toml
    #[default]
    Own,
    /// Follows its pulse at once, whatever it carries
    Ideal,
}

/// Runs the firmware, walks the robot and prints the report.
///
/// # Errors
/// Fails for an invalid robot.toml, a firmware that is missing or has another robot, an unknown gait, an invalid
/// script, a firmware that crashes, or an output that cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let script = choose_script(&args, &robot)?;
    let mut image = firmware::select_firmware(args.elf.as_deref(), &args.robot, &robot)?.image;
    let routine = args.gait.as_deref().and_then(|name| robot.routine(name));
    let has_inputs = routine.is_some_and(Routine::has_inputs);
    if has_inputs {
        image = firmware::without_contacts(image, &robot);
    }
    let mut uno = Uno::with_image(image, Fidelity::DataSheet);
    let recording = record(&mut uno, &robot, &script)?;
    let model = match args.servo {
        ServoArg::Own => ServoModel::of(&robot),
        ServoArg::Ideal => ServoModel::Ideal,
    };
    let spans = spans::command_spans(&script, &recording.answers);
    let changes_speed = script
        .steps
        .iter()
        .any(|step| step.command.starts_with("speed"));
    let spinner = Spinner::new("walking every frame");
    let replay = Replay::new(&robot, &recording.frames, spans, model);
    let report = Report::new(&robot, &replay, model, changes_speed);
    drop(spinner);

    let mut out = io::stdout().lock();
    if args.json {
        report.write_json(&mut out)?;
    } else {
        report.print(&mut out)?;
        if has_inputs {
            write!(out, "\n{WITHOUT_CONTACTS_NOTE}")?;
        }
    }
    if let Some(variation_count) = args.robust {
        robust::run(&robot, &replay, model, variation_count, args.json, &mut out)?;
    }
    Ok(out.flush()?)
}

/// Plays the script without printing anything.
///
/// # Errors
/// Fails if the firmware ends before the script does.
pub(crate) fn record(uno: &mut Uno, robot: &Robot, script: &Script) -> Result<Recording, Failure> {
    supplies::connect(uno, robot);
    let bar = time_progress_bar(script.end_ms);
    let pins = frame::servo_pins(robot);
    let recording = session::play(uno, pins, script, |event| {
        if let Event::Time(ms) = event {
            bar.set_position(ms);
        }
        Ok(())
    })?;
    bar.finish_and_clear();
    match recording.state {
        State::Alive => Ok(recording),
        _ => Err(Failure::Impossible(
            "the firmware ended; `lizard sim` says how".to_owned(),
        )),
    }
}

/// The script that the command-line options ask for.
fn choose_script(args: &Args, robot: &Robot) -> Result<Script, Failure> {
    if let Some(path) = &args.script {
        return read_script(path);
    }
    Ok(match &args.gait {
        None => walk_script(robot, &tour::moving_gaits(robot)),
        Some(name) => match robot.routine(name) {
            Some(routine) => round_script(robot, routine),
            None => walk_script(robot, &[moving_gait(robot, name)?.name()]),
        },
    })
}

/// Builds a script for one round of a routine. The round starts after a second of standing, and the script ends two
/// seconds after the round.
fn round_script(robot: &Robot, routine: &Routine) -> Script {
    const STAND_MS: u64 = 1000;
    let round = Round::of(robot, routine);
    let name = routine.command();
    let round_end_ms = STAND_MS + (1000.0 * round.seconds).ceil() as u64;
    let step_at = |ms, command: &str| Step {
        ms,
        command: command.to_owned(),
    };
    Script {
        steps: vec![
            step_at(STAND_MS, &format!("{name} 1")),
            step_at(round_end_ms + STAND_MS, "stop"),
        ],
        end_ms: round_end_ms + 2 * STAND_MS,
        ..Script::default()
    }
}

/// The gait of this name. Fails if the robot has no such gait or if the gait moves no servo.
pub(crate) fn moving_gait<'a>(robot: &'a Robot, name: &str) -> Result<&'a CheckedGait, Failure> {
    match robot.gait(name) {
        Some(gait) if gait.has_movement() => Ok(gait),
        Some(_) => Err(Failure::Input(format!("the gait `{name}` moves no servo"))),
        None => {
            let gaits = tour::moving_gaits(robot);
            Err(Failure::Input(format!(
                "robot.toml has no gait `{name}`; those that move are {}{}",
                gaits.join(", "),
                suggestion_text(name, gaits)
            )))
        }
    }
}

/// Builds a script that walks each of these gaits for three cycles, after a second in which the robot takes the gait's
/// first pose. The robot stands for a second before the first gait and after the last.
pub(crate) fn walk_script(robot: &Robot, gaits: &[&str]) -> Script {
    const CYCLES_PER_GAIT: f64 = 3.0;
    const STAND_MS: u64 = 1000;
    let mut ms = STAND_MS;
    let mut steps = Vec::new();
    for name in gaits {
        steps.push(Step {
            ms,
            command: command_of(name),
        });
        let period = robot.gait(name).map_or(1.0, |gait| gait.period());
        ms += STAND_MS + (1000.0 * CYCLES_PER_GAIT * period).ceil() as u64;
    }
    steps.push(Step {
        ms,
        command: "stop".to_owned(),
    });
    Script {
        steps,
        end_ms: ms + STAND_MS,
        ..Script::default()
    }
}
