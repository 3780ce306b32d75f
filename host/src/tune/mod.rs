//! `lizard tune`: searches gaits that walk faster with servos that turn no faster.

mod goal;
mod judge;
mod plan;
mod report;
mod search;

use std::io::{self, Write};

use indicatif::{ProgressBar, ProgressStyle};
use lizard_robot::{CheckedGait, Robot};
use serde::{Deserialize, Serialize};

use crate::json;
use crate::spread::{Spread, Spreads};
use crate::suggestion::did_you_mean;
use crate::{Failure, RobotFile};
use goal::Goal;
use judge::{Built, Judge, STAND};
use plan::{Kind, Plan, Space};
use report::Report;

/// Random robots that a gait is judged by while it is searched.
const JUDGES: usize = 16;
/// Those that the report is of come from seeds that the search has not seen.
const FRESH: u64 = 1 << 40;
/// Servos slower than this do not walk, deg/s.
const SLOWEST: f64 = 10.0;

/// Search a gait that walks faster with the same servo rate
///
/// Takes a gait of robot.toml that goes straight ahead or turns on the spot, and searches
/// a wave or a held gait that goes farther in a second while its fastest servo turns no
/// faster. Each candidate is checked against robot.toml's limits and judged by the
/// contact model with SG-90 servos on random robots and floors: 95 % of them exceed its
/// score. Finally the best one is compared with the given gait on other random robots,
/// and its table for robot.toml is printed. The same seed gives the same result on every
/// machine.
#[derive(clap::Args, Debug, Serialize, Deserialize)]
#[command(after_help = "Examples:
  lizard tune
  lizard tune --gait left
  lizard tune --rate 200 --name gentle >> robot.toml
  lizard tune --rounds 60 --seed 2 --json

In a terminal or a file, what is not the table is a comment, so the output may be appended to
a robot.toml as it is.")]
pub struct Args {
    /// The gait to improve; it goes straight ahead or turns on the spot
    #[arg(long, value_name = "NAME", default_value = "walk")]
    gait: String,
    /// How fast a servo may turn, deg/s [default: as in that gait]
    #[arg(long, value_name = "DEG_PER_S", allow_negative_numbers = true)]
    rate: Option<f64>,
    /// The name for the gait that is found
    #[arg(long, value_name = "NAME", default_value = "tuned")]
    name: String,
    /// Rounds of the search, 40 trials each
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rounds: u32,
    /// Number of random robots and floors for the comparison
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 200, value_parser = clap::value_parser!(u32).range(20..=100_000))]
    robots: u32,
    /// Seed of the random numbers
    #[arg(
        long,
        value_name = "N",
        allow_negative_numbers = true,
        default_value_t = 1
    )]
    seed: u64,
    /// Print one JSON object instead
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    #[serde(skip)]
    robot: RobotFile,
    #[command(flatten)]
    #[serde(skip)]
    spread: Spread,
}

impl Spreads for Args {
    const COMMAND: &'static str = "tune";

    fn places(&mut self) -> (&mut RobotFile, &mut Spread) {
        (&mut self.robot, &mut self.spread)
    }
}

/// Searches and tells.
///
/// # Errors
/// A wrong robot.toml, a gait that is not there or cannot be tuned, a rate or a name that will not
/// do; no gait that the limits allow; an output that cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let Some(report) = tune(&robot, &args)? else {
        return Ok(());
    };
    let mut out = io::stdout().lock();
    if args.json {
        json::line(&mut out, &report)?;
    } else {
        report.print(&mut out)?;
    }
    Ok(out.flush()?)
}

/// The report; none where a part was computed alone.
fn tune(robot: &Robot, args: &Args) -> Result<Option<Report>, Failure> {
    let gait = surpassed(robot, &args.gait)?;
    let goal = Goal::of(gait, robot.ground())?;
    let rate = rate(robot, gait, args.rate)?;
    free(robot, &args.name)?;
    let Some(found) = found(robot, args, goal, rate)? else {
        return Ok(None);
    };
    let judge = Judge::new(
        robot,
        goal,
        args.robots as usize,
        args.seed.wrapping_add(FRESH),
    );
    let report = Report::of(robot, &judge, goal, rate, gait, &found);
    Ok(Some(report))
}

fn surpassed<'a>(robot: &'a Robot, name: &str) -> Result<&'a CheckedGait, Failure> {
    robot.gait(name).ok_or_else(|| {
        let moving = robot.gaits().iter().filter(|gait| gait.moves());
        let gaits: Vec<&str> = moving.map(|gait| gait.name()).collect();
        Failure::Input(format!(
            "robot.toml has no gait `{name}` to surpass; --gait takes one of {}{}",
            gaits.join(", "),
            did_you_mean(name, gaits)
        ))
    })
}

/// How fast servos may turn: as asked, or as fast as in the gait.
fn rate(robot: &Robot, gait: &CheckedGait, asked: Option<f64>) -> Result<f64, Failure> {
    let Some(rate) = asked else {
        return Ok(gait.audit().peak.speed);
    };
    let most = robot.pace().gait_slew;
    if (SLOWEST..=most).contains(&rate) {
        return Ok(rate);
    }
    Err(Failure::Input(format!(
        "--rate {rate}: from {SLOWEST} to {most} deg/s, which is limits.gait_slew in robot.toml"
    )))
}

/// Refuses a name that robot.toml has already or would not take.
fn free(robot: &Robot, name: &str) -> Result<(), Failure> {
    let refused = |why: String| Err(Failure::Input(format!("--name {name}: {why}")));
    if robot.gait(name).is_some() {
        return refused("robot.toml has a gait of this name already".to_owned());
    }
    let gait = format!("{STAND}[gait.{name:?}]\nperiod = 1.0\nwaveform = \"still\"\n");
    match robot.with_gaits(&gait) {
        Err(error) => refused(error.problem.to_string()),
        Ok(read) if read.gait(name).is_none() => refused("it is no name".to_owned()),
        Ok(_) => Ok(()),
    }
}

/// The best gait of all kinds whose way does not depend on ties; none where a part was
/// computed alone. Kinds are searched apart from each other, and so are the pieces.
fn found(robot: &Robot, args: &Args, goal: Goal, rate: f64) -> Result<Option<Built>, Failure> {
    let rounds = args.rounds as usize;
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} gaits, {eta}")
        .expect("the template is well formed");
    let kinds = args.spread.own(Kind::ALL.len());
    let bar = ProgressBar::new((kinds * search::trials(rounds)) as u64).with_style(style);
    let judge = Judge::new(robot, goal, JUDGES, args.seed);
    let widest = Built::widest(robot, goal, rate);
    let space = Space { goal, widest };
    let build = |kind: Kind, parameters: &[f64]| {
        Built::of(robot, &Plan::of(kind, space, parameters), &args.name, rate)
    };
    let one = |place: usize| -> Vec<(f64, Vec<f64>)> {
        let kind = Kind::ALL[place];
        let judged = |parameters: &[f64]| {
            bar.inc(1);
            Some((judge.score(build(kind, parameters)?.gait())?, ()))
        };
        let seed = args.seed.wrapping_add(place as u64);
        let members = search::search(&kind.begin(), rounds, seed, judged);
        let scores = members
            .into_iter()
            .filter_map(|member| Some((member.found?.0, member.parameters)));
        scores.collect()
    };
    let pieces = args.spread.all(args, &args.robot, Kind::ALL.len(), one)?;
    bar.finish_and_clear();
    let Some(pieces) = pieces else {
        return Ok(None);
    };
    let mut best: Vec<(Kind, f64, Vec<f64>)> = Vec::new();
    for (kind, piece) in Kind::ALL.into_iter().zip(pieces) {
        best.extend(
            piece
                .into_iter()
                .map(|(score, parameters)| (kind, score, parameters)),
        );
    }
    best.sort_by(|a, b| b.1.total_cmp(&a.1));
    let decided = |built: &Built| built.gait().predict(robot.ground()).is_decided();
    best.into_iter()
        .filter_map(|(kind, _, parameters)| build(kind, &parameters))
        .find(decided)
        .map(Some)
        .ok_or_else(|| {
            Failure::Impossible(format!(
                "no gait was found that robot.toml's limits allow at {rate:.0} deg/s; more --rounds may find one"
            ))
        })
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;

    #[derive(clap::Parser)]
    struct Line {
        #[command(flatten)]
        args: Args,
    }

    const PAPER: &str = include_str!("../../../robots/paper.toml");

    fn tuned(words: &str) -> Result<Report, String> {
        let robot = Robot::parse(PAPER).expect("right");
        let line = Line::try_parse_from(std::iter::once("tune").chain(words.split_whitespace()));
        let args = line.map_err(|error| error.to_string())?.args;
        let report = tune(&robot, &args).map_err(|failure| failure.to_string())?;
        Ok(report.expect("all parts"))
    }

    /// Of `lizard tune --rounds 1 --robot robots/paper.toml`, which docs/twin.md quotes.
    #[test]
    fn a_short_search_surpasses_walk_at_the_same_rate_as_the_docs_say() {
        let report = tuned("--rounds 1").expect("it finds one");
        let (walk, found) = (&report.gait, &report.tuned);
        assert!(found.rate <= walk.rate, "{found:?}");
        assert!(found.speeds[0] > 1.15 * walk.speeds[0], "{report:?}");
        assert!(report.faster >= 195, "{report:?}");
        // What is printed may be appended to a robot.toml, and walks as it says.
        let mut printed = Vec::new();
        report.print(&mut printed).expect("written");
        let printed = String::from_utf8(printed).expect("text");
        let robot = Robot::parse(&format!("{PAPER}\n{printed}")).expect("it builds");
        let gait = robot.gait("tuned").expect("the gait");
        let forward = robot.predict(gait).forward.expect("decided");
        assert!(
            (forward / gait.period() - found.predicted).abs() < 0.01,
            "{forward}"
        );
        assert!(
            include_str!("../../../docs/twin.md").contains(&format!("```text\n{printed}```")),
            "docs/twin.md does not quote\n{printed}"
        );
    }

    #[test]
    fn what_cannot_be_tuned_says_why() {
        for (words, why) in [
            (
                "--gait run",
                "no gait `run` to surpass; --gait takes one of walk, trot, crawl",
            ),
            ("--gait stand", "the gait `stand` goes nowhere"),
            ("--gait look", "undecided"),
            ("--gait arc-left", "goes ahead and turns"),
            (
                "--rate 900",
                "--rate 900: from 10 to 310 deg/s, which is limits.gait_slew",
            ),
            ("--rate -5", "--rate -5: from 10 to 310 deg/s"),
            ("--rate nan", "--rate NaN: from 10"),
            (
                "--name walk",
                "--name walk: robot.toml has a gait of this name already",
            ),
            ("--name Fast", "--name Fast: is no gait name: it must be"),
            ("--name status", "--name status: "),
            ("--name a.b", "--name a.b: is no gait name"),
            ("--seed -1", "invalid value '-1' for '--seed <N>'"),
            ("--rounds 0", "0 is not in 1..=10000"),
            ("--robots 3", "3 is not in 20..=100000"),
        ] {
            let said = tuned(words).expect_err(words);
            assert!(said.contains(why), "{words}: {said}");
        }
    }
}
