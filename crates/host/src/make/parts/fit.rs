//! `lizard fit`: proves how close the robot's parts can come to each other.

use std::io::{self, Write};

use lizard_parts::{Answer, Assembly, BuildProblem, FAR_MM, NearestPair, Proof, Questions};
use lizard_robot::servo::SERVO_NAMES;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::shared::progress::progress_bar;
use crate::shared::spread::{SpreadArgs, Spreadable};

/// Prove that no two parts meet at any pose that the guard accepts
///
/// Servos, screws, nuts, springs, board and battery are parts, too. The proof covers all
/// poses, not samples: the servos' angles are divided into regions, and in each region
/// either the guard refuses every pose, or no two parts can come closer than is printed.
/// Clearances up to 2 mm are measured. docs/fit.md says what is proved and what is not.
/// The exit code is 1 if two parts overlap or come closer than 0.2 mm.
#[derive(clap::Args, Debug, Serialize, Deserialize)]
#[command(after_help = "Examples:
  lizard fit
  lizard fit --robot robots/unequal.toml --all")]
pub struct Args {
    /// Print every pair for which less than 1.8 mm is proved, not only the closest ten
    #[arg(long)]
    all: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    #[serde(skip)]
    spread: SpreadArgs,
}

impl Spreadable for Args {
    const COMMAND: &'static str = "fit";

    fn spread_args(&mut self) -> &mut SpreadArgs {
        &mut self.spread
    }
}

/// Two parts as `--json` prints them.
#[derive(Serialize)]
struct Pair<'a> {
    first: &'a str,
    second: &'a str,
    /// Proved lower bound of the distance, mm; below 0 the parts may overlap.
    proved: f64,
    /// The least distance found at a pose that the guard accepts, mm; null if none is found.
    seen: Option<f64>,
    /// The pose at which `seen` was found: A1 to A4, deg; null if `seen` is null.
    pose: Option<[f64; 4]>,
    /// The pose (A1 to A4, deg) near which `proved` could not be raised; null if `proved` is close to `seen`.
    doubt: Option<[f64; 4]>,
}

/// The proof as `--json` prints it.
#[derive(Serialize)]
struct Report<'a> {
    fits: bool,
    /// The reason why the parts do not fit; null if they do.
    reason: Option<String>,
    /// The closest pairs of parts that must stay apart.
    apart: Vec<Pair<'a>>,
    /// The closest pairs of parts that are designed to touch.
    meeting: Vec<Pair<'a>>,
    /// The ranges of A1 to A4 over all poses that the guard accepts, deg.
    ranges: [[f64; 2]; 4],
    /// The number of pairs of shapes in the proof.
    pairs: usize,
    /// The number of regions of poses into which the proof was divided.
    regions: u64,
}

impl<'a> From<&'a NearestPair> for Pair<'a> {
    fn from(pair: &'a NearestPair) -> Self {
        Self {
            first: &pair.first,
            second: &pair.second,
            proved: pair.lower_bound,
            seen: pair.witness.as_ref().map(|clearance| clearance.mm),
            pose: pair.witness.as_ref().map(|clearance| clearance.pose),
            doubt: pair.unproved_angles,
        }
    }
}

/// Template of the progress bar, which counts pairs of mounts (groups of parts that move together).
const BAR_TEMPLATE: &str = "{wide_bar} {pos}/{len} looking for parts that meet";

/// Proves how close the parts come to each other, with a progress bar.
pub(super) fn prove(assembly: &Assembly) -> Proof {
    complete_proof(&Questions::new(assembly, |_, _| true), None)
}

/// Completes the proof: uses the answers from a merge, and computes the missing ones.
fn complete_proof(questions: &Questions, answers: Option<Vec<Answer>>) -> Proof {
    let bar = progress_bar(questions.count(), BAR_TEMPLATE);
    let known_answer = |index: usize| answers.as_ref()?.get(index).cloned();
    let proof = questions.answer_all(known_answer, |done_count, _| {
        bar.set_position(done_count as u64)
    });
    bar.finish_and_clear();
    proof
}

/// Proves that the parts fit and prints the clearances.
///
/// # Errors
/// Fails for an invalid robot.toml, contradictory dimensions, or parts that come too close.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.spread.robot.load()?;
    let assembly = Assembly::new(&robot);
    assembly.check_dimensions()?;
    let questions = Questions::new(&assembly, |_, _| true);
    let question_count = questions.count();
    if let Some(part) = args.spread.part() {
        let bar = progress_bar(part.piece_count(question_count), BAR_TEMPLATE);
        let answer_one = |index| {
            bar.inc(1);
            questions.answer_one(index)
        };
        part.print(&args, &args.spread.robot, question_count, answer_one)?;
        bar.finish_and_clear();
        return Ok(());
    }
    let proof = complete_proof(&questions, args.spread.read_merged(question_count)?);
    let verdict = proof.judge();
    let mut out = io::stdout().lock();
    if args.json {
        let report = Report {
            fits: verdict.is_ok(),
            reason: verdict.as_ref().err().map(ToString::to_string),
            apart: proof.separate_pairs.iter().map(Pair::from).collect(),
            meeting: proof.touching_pairs.iter().map(Pair::from).collect(),
            ranges: proof.ranges,
            pairs: proof.shape_pair_count,
            regions: proof.region_count,
        };
        serde_json::to_writer(&mut out, &report)?;
        writeln!(out)?;
    } else {
        print_proof(&proof, args.all, &mut out)?;
    }
    out.flush()?;
    verdict.map_err(|clash| BuildProblem::from(clash).into())
}

fn print_proof(proof: &Proof, show_all: bool, out: &mut impl Write) -> io::Result<()> {
    /// The largest number of rows in a list without --all.
    const MAX_ROWS: usize = 10;
    writeln!(
        out,
        "proved   seen   parts                                          at A1 A2 A3 A4, deg"
    )?;
    writeln!(out, "    mm     mm")?;
    let print_list = |pairs: &[NearestPair], out: &mut dyn Write| -> io::Result<()> {
        let close_pairs: Vec<_> = pairs
            .iter()
            .filter(|pair| pair.lower_bound < FAR_MM * 0.9)
            .collect();
        let row_count = if show_all {
            close_pairs.len()
        } else {
            MAX_ROWS.min(close_pairs.len())
        };
        for pair in &close_pairs[..row_count] {
            print_row(pair, out)?;
        }
        match close_pairs.len() - row_count {
            0 => Ok(()),
            hidden_count => writeln!(out, "... and {hidden_count} more (--all)"),
        }
    };
    print_list(&proof.separate_pairs, out)?;
    writeln!(out, "\nmade to touch: gap between them")?;
    print_list(&proof.touching_pairs, out)?;
    writeln!(out, "\nranges of the servo angles that the guard accepts")?;
    for (name, [from, to]) in SERVO_NAMES.iter().zip(proof.ranges) {
        writeln!(out, "  {name} {from:7.2} to {to:7.2} deg")?;
    }
    writeln!(
        out,
        "{} pairs of shapes, {} regions of poses",
        proof.shape_pair_count, proof.region_count
    )?;
    if let (Ok(()), Some(nearest)) = (proof.judge(), proof.nearest_separate_pair()) {
        writeln!(
            out,
            "no two parts come nearer than {:.2} mm at any pose that the guard accepts",
            nearest.lower_bound
        )?;
    }
    Ok(())
}

fn print_row(pair: &NearestPair, out: &mut dyn Write) -> io::Result<()> {
    let witness = pair.witness.as_ref();
    let parts = format!("{}, {}", pair.first, pair.second);
    write!(
        out,
        "{:6.2} {:>6}   {parts:<44}",
        pair.lower_bound,
        witness.map_or("-".to_owned(), |clearance| format!("{:.2}", clearance.mm))
    )?;
    if let Some(pose) = witness
        .map(|clearance| clearance.pose)
        .or(pair.unproved_angles)
    {
        for angle in pose {
            write!(out, " {angle:6.1}")?;
        }
    }
    writeln!(out)
}
