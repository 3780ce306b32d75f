//! `lizard tune`: searches for faster gaits at the same servo speed.

mod report;

use lizard_robot::{CheckedGait, Robot};
use lizard_tune::{BuiltGait, Comparison, GaitKind, Tuning, TuningError, trial_count};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::shared::json;
use crate::shared::number::whole_number_parser;
use crate::shared::progress::create_progress_bar;
use crate::shared::quantity::Quantity;
use crate::shared::robot_args::unknown_gait_failure;
use crate::shared::spread::{SpreadArgs, Spreadable};

/// Search for a faster gait at the same servo speed
///
/// Takes a gait from robot.toml that goes straight ahead or turns on the spot, and searches
/// for a faster wave or held gait whose fastest servo turns no faster. Each candidate is
/// checked against robot.toml's limits and simulated with SG-90 servos and the contact model
/// on random robots and floors; its score is the speed that 95 % of them exceed. Finally, the
/// command compares the best candidate with the given gait on other random robots, and prints
/// the new gait's table for robot.toml. The same seed gives the same result on every machine.
#[derive(clap::Args, Debug, Serialize, Deserialize)]
#[command(after_help = "Examples:
  lizard tune
  lizard tune --gait left
  lizard tune --rate 200 --name gentle >> robot.toml
  lizard tune --rounds 60 --seed 2 --json

Without --json, everything except the table is a comment, so the output can be appended to
a robot.toml unchanged.")]
pub struct Args {
    /// The gait to improve; it must go straight ahead or turn on the spot
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "NAME", default_value = "walk")]
    gait: String,
    /// Highest servo speed, deg/s [default: the given gait's]
    #[arg(long, value_name = "DEG_PER_S", allow_negative_numbers = true, value_parser = Quantity::RATE.parser())]
    rate: Option<f64>,
    /// Name of the new gait
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "NAME", default_value = "tuned")]
    name: String,
    /// Number of search rounds, 40 trials each
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 25,
          value_parser = whole_number_parser::<u32>(1, 10_000))]
    rounds: u32,
    /// Number of random robots and floors for the comparison, at least 20
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 200,
          value_parser = whole_number_parser::<u32>(20, 100_000))]
    robots: u32,
    /// Seed of the random numbers
    #[arg(
        long,
        value_name = "N",
        allow_negative_numbers = true,
        default_value_t = 1,
        value_parser = whole_number_parser(0, u64::MAX)
    )]
    seed: u64,
    /// Print one JSON object instead
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    #[serde(skip)]
    spread: SpreadArgs,
}

impl Spreadable for Args {
    const COMMAND: &'static str = "tune";

    fn spread_args(&mut self) -> &mut SpreadArgs {
        &mut self.spread
    }
}

/// Searches for a gait and prints it.
///
/// # Errors
/// Fails if robot.toml, the rate or the name is invalid, if the gait does not exist or cannot be tuned, if the search
/// finds no gait within the limits, or if the output cannot be written. Also fails, after an output in which the new
/// gait is a comment, if robot.toml has no room for it.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.spread.robot.load()?;
    // The output may be appended to robot.toml, so the old text is read first.
    let robot_toml = args.spread.robot.text()?;
    let Some(comparison) = tune(&robot, &args)? else {
        return Ok(());
    };
    let room = check_room(robot_toml, &comparison.fragment);
    json::print_json_or_text(args.json, &comparison, || {
        format_addition(&comparison, room.is_ok())
    })?;
    room
}

/// Formats the comparison so that it can be appended to robot.toml: if there is no room for the new gait, its table is
/// also a comment.
fn format_addition(comparison: &Comparison, has_room: bool) -> String {
    let text = report::format(comparison);
    if has_room {
        return text;
    }
    let lines = text.lines().map(|line| match line {
        "" => "\n".to_owned(),
        line if line.starts_with('#') => format!("{line}\n"),
        line => format!("# {line}\n"),
    });
    lines.collect()
}

/// Refuses the table of a new gait with which robot.toml would be invalid, for example too large for the board.
fn check_room(robot_toml: &str, gait_table: &str) -> Result<(), Failure> {
    let new_robot = Robot::parse(&format!("{robot_toml}\n{gait_table}"));
    new_robot.map(|_| ()).map_err(|error| {
        let message = format!("with the new gait, robot.toml would be invalid: {error}");
        Failure::Operation(message)
    })
}

/// Searches for a gait and compares it with the given one; `None` if this process computed only a part of the search.
fn tune(robot: &Robot, args: &Args) -> Result<Option<Comparison>, Failure> {
    let gait = find_gait(robot, &args.gait)?;
    check_name(robot, &args.name)?;
    let tuning = Tuning::new(
        robot,
        robot.ground(),
        gait,
        args.rate,
        &args.name,
        args.seed,
    )
    .map_err(|error| {
        Failure::Input(match error {
            TuningError::Goal(_) => error.to_string(),
            TuningError::ServoSpeed { .. } => format!("--rate {error}"),
        })
    })?;
    let best = search_all(&tuning, args)?;
    Ok(best.map(|best| tuning.compare(&best, args.robots as usize)))
}

/// Returns the gait called `name`, the start of the search.
fn find_gait<'a>(robot: &'a Robot, name: &str) -> Result<&'a CheckedGait, Failure> {
    robot.gait(name).ok_or_else(|| {
        let problem = format!("--gait {name}: unknown gait");
        let moving_gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
        unknown_gait_failure(&problem, name, moving_gaits)
    })
}

/// Refuses a name that is invalid or that a gait or routine of robot.toml already has.
fn check_name(robot: &Robot, name: &str) -> Result<(), Failure> {
    let refuse = |reason: String| Err(Failure::Input(format!("--name {name}: {reason}")));
    if robot.gait(name).is_some() || robot.routine(name).is_some() {
        return refuse("robot.toml already has a gait or routine with this name".to_owned());
    }
    let gait_toml = format!("[gait.{name:?}]\nperiod = 1.0\nwaveform = \"still\"\n");
    match robot.with_gait(&gait_toml) {
        Err(error) => refuse(error.problem),
        Ok(new_robot) if new_robot.gait(name).is_none() => {
            refuse("it is not a valid name".to_owned())
        }
        Ok(_) => Ok(()),
    }
}

/// Finds the best gait of all kinds; `None` if this process computed only a part of the search. Each kind is a
/// separate piece of the search; the trials of a round are distributed over all cores.
fn search_all(tuning: &Tuning, args: &Args) -> Result<Option<BuiltGait>, Failure> {
    let round_count = args.rounds as usize;
    let kind_count = args.spread.count_own_pieces(GaitKind::ALL.len());
    let bar = create_progress_bar(
        kind_count * trial_count(round_count),
        "{bar:40} {pos}/{len} gaits, {eta}",
    );
    let search_kind = |index: usize| -> Vec<(f64, Vec<f64>)> {
        let kind = GaitKind::ALL[index];
        let mut search = tuning.start_search(kind);
        for _ in 0..=round_count {
            let trial_scores = search.trials().par_iter().map(|parameters| {
                bar.inc(1);
                tuning.score(kind, parameters)
            });
            let scores: Vec<_> = trial_scores.collect();
            search.accept_scores(scores);
        }
        search.ranked_results()
    };
    let pieces = args
        .spread
        .run_pieces(args, GaitKind::ALL.len(), search_kind)?;
    bar.finish_and_clear();
    let Some(pieces) = pieces else {
        return Ok(None);
    };
    let best = tuning.build_best(pieces);
    best.map(Some).ok_or_else(|| {
        let servo_speed = tuning.max_servo_speed();
        Failure::Operation(format!(
            "found no gait within robot.toml's limits at {servo_speed:.0} deg/s; try more --rounds"
        ))
    })
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;

    #[derive(clap::Parser)]
    struct CommandLine {
        #[command(flatten)]
        args: Args,
    }

    const PAPER_TOML: &str = include_str!("../../../../../robots/paper.toml");

    fn run_tune(arguments: &str) -> Result<Comparison, String> {
        let robot = Robot::parse(PAPER_TOML).expect("paper.toml is valid");
        let words = ["tune"].into_iter().chain(arguments.split_whitespace());
        let command_line = CommandLine::try_parse_from(words);
        let args = command_line.map_err(|error| error.to_string())?.args;
        let comparison = tune(&robot, &args).map_err(|failure| failure.to_string())?;
        Ok(comparison.expect("one process computes all parts"))
    }

    /// Checks the output of `lizard tune --rounds 1 --robot robots/paper.toml` in docs/twin.md.
    #[test]
    fn a_short_search_beats_walk_at_the_same_rate_and_matches_the_docs() {
        let comparison = run_tune("--rounds 1").expect("the search finds a gait");
        let (walk, tuned) = (&comparison.gait, &comparison.tuned);
        assert!(tuned.rate <= walk.rate, "{tuned:?}");
        assert!(tuned.speeds[0] > 1.15 * walk.speeds[0], "{comparison:?}");
        assert!(comparison.faster_count >= 195, "{comparison:?}");
        // The printed text can be appended to a robot.toml, and its gait moves as predicted.
        let printed = report::format(&comparison);
        let robot = Robot::parse(&format!("{PAPER_TOML}\n{printed}"));
        let robot = robot.expect("the printed gait is valid");
        let gait = robot.gait("tuned").expect("the printed gait exists");
        let forward = robot.predict(gait).forward;
        let forward = forward.expect("the contact model predicts the distance");
        let speed = forward / gait.period();
        assert!((speed - tuned.predicted).abs() < 0.01, "{forward}");
        // Appended to a full robot.toml, the text changes nothing.
        let full_toml = fill_board();
        assert!(check_room(&full_toml, &comparison.fragment).is_err());
        let addition = format_addition(&comparison, false);
        let robot = Robot::parse(&format!("{full_toml}\n{addition}"));
        let robot = robot.expect("the addition is a comment");
        assert!(robot.gait("tuned").is_none(), "{addition}");
        assert!(addition.contains("\n# [gait.tuned]\n"), "{addition}");
        assert_eq!(format_addition(&comparison, true), printed);
        let docs = include_str!("../../../../../docs/twin.md");
        let is_quoted = docs.contains(&format!("```text\n{printed}```"));
        assert!(is_quoted, "docs/twin.md does not quote\n{printed}");
    }

    #[test]
    fn the_error_for_an_invalid_argument_states_the_reason() {
        for (arguments, reason) in [
            (
                "--gait run",
                "--gait run: unknown gait; allowed values: walk, trot, crawl",
            ),
            ("--gait stand", "the gait `stand` does not move the robot"),
            ("--gait look", "undetermined"),
            ("--gait arc-left", "walks along a curve"),
            (
                "--rate 900",
                "--rate 900: must be between 10 and 310 deg/s (limits.gait_slew",
            ),
            ("--rate -5", "--rate -5: must be between 10 and 310 deg/s"),
            ("--rate nan", "it is not a finite number"),
            ("--rate fast", "it is not a number"),
            (
                "--name walk",
                "--name walk: robot.toml already has a gait or routine with this name",
            ),
            (
                "--name Fast",
                "--name Fast: is not a gait name: it must consist of",
            ),
            ("--name status", "--name status: "),
            ("--name a.b", "--name a.b: is not a gait name"),
            ("--seed -1", "invalid value '-1' for '--seed <N>'"),
            ("--rounds 0", "must be a whole number from 1 to 10000"),
            ("--robots 3", "must be a whole number from 20 to 100000"),
            ("--robots x", "must be a whole number from 20 to 100000"),
        ] {
            let message = run_tune(arguments).expect_err(arguments);
            assert!(message.contains(reason), "{arguments}: {message}");
        }
    }

    /// Formats a gait's table.
    fn format_gait(name: &str, duty: usize) -> String {
        format!(
            "[gait.{name}]\nperiod = 2.0\nwaveform = \"wave\"\nduty = 0.{duty}\namplitude = 10.0\n\
             start = {{ LF = 0.25, RF = 0.75, RH = 0.5, LH = 0.0 }}\n"
        )
    }

    /// Returns the paper's robot.toml with as many further gaits as the board has room for.
    fn fill_board() -> String {
        // Each of these gaits has its own waveform.
        let mut full_toml = PAPER_TOML.to_owned();
        for duty in 51..72 {
            let next_toml = format!("{full_toml}\n{}", format_gait(&format!("g{duty}"), duty));
            if Robot::parse(&next_toml).is_err() {
                break;
            }
            full_toml = next_toml;
        }
        full_toml
    }

    #[test]
    fn a_gait_for_which_the_board_has_no_room_is_refused() {
        let new_gait = format_gait("tuned", 72);
        assert!(check_room(PAPER_TOML, &new_gait).is_ok());
        let failure = check_room(&fill_board(), &new_gait).expect_err("the board is full");
        let message = failure.to_string();
        assert!(
            message.contains("the board's limit of 4096 bytes"),
            "{message}"
        );
    }

    #[test]
    fn the_name_of_a_routine_is_refused() {
        let routine = "[routine.patrol]\nsteps = [\"walk 4\"]\n";
        let robot = Robot::parse(&format!("{PAPER_TOML}\n{routine}"));
        let robot = robot.expect("the robot is valid");
        assert!(check_name(&robot, "patrol").is_err());
        assert!(check_name(&robot, "tuned").is_ok());
    }
}
