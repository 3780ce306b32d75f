//! `lizard fit`: proves lower bounds of the distances between the robot's parts.

use std::io::{self, Write};

use lizard_parts::{Assembly, BuildError, FAR_MM, NearestPair, Proof, ProofTasks, TaskResult};
use lizard_robot::servo::SERVO_NAMES;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::shared::progress::create_progress_bar;
use crate::shared::spread::{SpreadArgs, Spreadable};

/// Prove that no two parts meet at any pose that the guard accepts
///
/// Servos, screws, nuts, springs, board and battery are parts, too. The proof covers all
/// poses, not samples: the servo angles are divided into regions. In each region, either the
/// guard refuses every pose, or no two parts can come closer than the printed distance.
/// Clearances up to 2 mm are measured. docs/fit.md describes the scope of the proof.
/// The exit code is 1 if two parts overlap or come closer than 0.2 mm.
#[derive(clap::Args, Debug, Serialize, Deserialize)]
#[command(after_help = "Examples:
  lizard fit
  lizard fit --robot robots/unequal.toml --all")]
pub struct Args {
    /// Print every pair with a proved distance below 1.8 mm, not only the closest ten
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

/// Two parts in the `--json` output; the serialized field names are the JSON keys.
#[derive(Serialize)]
struct PairReport<'a> {
    first: &'a str,
    second: &'a str,
    /// Proved lower bound of the distance, mm; the parts may overlap if it is negative.
    #[serde(rename = "proved")]
    lower_bound: f64,
    /// The smallest distance found at an accepted pose, mm; null if none was found.
    seen: Option<f64>,
    /// The pose at which `seen` was found: A1 to A4, deg; null if `seen` is null.
    pose: Option<[f64; 4]>,
    /// The pose (A1 to A4, deg) that limits `lower_bound`; null if `lower_bound` is close to `seen`.
    #[serde(rename = "doubt")]
    unproved_angles: Option<[f64; 4]>,
}

/// The proof in the `--json` output; the serialized field names are the JSON keys.
#[derive(Serialize)]
struct FitReport<'a> {
    fits: bool,
    /// The reason for a misfit; null if the parts fit.
    reason: Option<String>,
    /// The closest pairs of parts that must stay apart.
    apart: Vec<PairReport<'a>>,
    /// The closest pairs of parts that are designed to touch.
    meeting: Vec<PairReport<'a>>,
    /// The ranges of A1 to A4 over all accepted poses, deg.
    ranges: [[f64; 2]; 4],
    /// The number of pairs of shapes in the proof.
    #[serde(rename = "pairs")]
    shape_pair_count: usize,
    /// The number of pose regions in the proof.
    #[serde(rename = "regions")]
    region_count: u64,
}

impl<'a> From<&'a NearestPair> for PairReport<'a> {
    fn from(pair: &'a NearestPair) -> Self {
        Self {
            first: &pair.first,
            second: &pair.second,
            lower_bound: pair.lower_bound,
            seen: pair.witness.as_ref().map(|clearance| clearance.mm),
            pose: pair.witness.as_ref().map(|clearance| clearance.pose),
            unproved_angles: pair.unproved_angles,
        }
    }
}

/// Template of the progress bar, which counts pairs of mounts (groups of parts that move together).
const BAR_TEMPLATE: &str = "{wide_bar} {pos}/{len} searching for colliding parts";

/// Proves the distances between the parts, with a progress bar.
pub(super) fn prove(assembly: &Assembly) -> Proof {
    complete_proof(&ProofTasks::new(assembly, |_, _| true), None)
}

/// Completes the proof: uses the results from a merge, and computes the missing results.
fn complete_proof(tasks: &ProofTasks, results: Option<Vec<TaskResult>>) -> Proof {
    let bar = create_progress_bar(tasks.count(), BAR_TEMPLATE);
    let known_result = |index: usize| results.as_ref()?.get(index).cloned();
    let proof = tasks.complete_all(known_result, |done_count, _| {
        bar.set_position(done_count as u64)
    });
    bar.finish_and_clear();
    proof
}

/// Proves that the parts fit and prints the clearances.
///
/// # Errors
/// Fails if robot.toml is invalid, if its dimensions contradict each other, or if parts come too close.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.spread.robot.load()?;
    let assembly = Assembly::new(&robot);
    assembly.check_dimensions()?;
    let tasks = ProofTasks::new(&assembly, |_, _| true);
    let task_count = tasks.count();
    if let Some(part) = args.spread.part() {
        let bar = create_progress_bar(part.count_pieces(task_count), BAR_TEMPLATE);
        let complete_task = |index| {
            bar.inc(1);
            tasks.complete_one(index)
        };
        part.compute_and_print(&args, &args.spread.robot, task_count, complete_task)?;
        bar.finish_and_clear();
        return Ok(());
    }
    let proof = complete_proof(&tasks, args.spread.read_merged(task_count)?);
    let verdict = proof.check();
    let mut out = io::stdout().lock();
    if args.json {
        let report = FitReport {
            fits: verdict.is_ok(),
            reason: verdict.as_ref().err().map(ToString::to_string),
            apart: proof.separate_pairs.iter().map(PairReport::from).collect(),
            meeting: proof.touching_pairs.iter().map(PairReport::from).collect(),
            ranges: proof.ranges,
            shape_pair_count: proof.shape_pair_count,
            region_count: proof.region_count,
        };
        serde_json::to_writer(&mut out, &report)?;
        writeln!(out)?;
    } else {
        print_proof(&proof, args.all, &mut out)?;
    }
    out.flush()?;
    verdict.map_err(|clash| BuildError::from(clash).into())
}

fn print_proof(proof: &Proof, prints_all: bool, out: &mut impl Write) -> io::Result<()> {
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
        let row_count = if prints_all {
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
    writeln!(out, "\ndesigned to touch: gap between the parts")?;
    print_list(&proof.touching_pairs, out)?;
    writeln!(out, "\nranges of the servo angles that the guard accepts")?;
    for (name, [min, max]) in SERVO_NAMES.iter().zip(proof.ranges) {
        writeln!(out, "  {name} {min:7.2} to {max:7.2} deg")?;
    }
    writeln!(
        out,
        "{} pairs of shapes, {} regions of poses",
        proof.shape_pair_count, proof.region_count
    )?;
    if let (Ok(()), Some(nearest)) = (proof.check(), proof.nearest_separate_pair()) {
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
