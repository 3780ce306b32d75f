//! `lizard fit`: proves lower bounds of the distances between the robot's parts.

use std::fmt::Write as _;

use lizard_parts::{Assembly, BuildError, FAR_MM, NearestPair, Proof, ProofTasks, TaskResult};
use lizard_robot::servo::SERVO_NAMES;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::shared::json;
use crate::shared::number::format_or_dash;
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
    /// True if the proof shows that no two parts overlap or come too close.
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
    tasks.complete_all(known_result, |done_count, _| {
        bar.set_position(done_count as u64)
    })
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
    let report = FitReport {
        fits: verdict.is_ok(),
        reason: verdict.as_ref().err().map(ToString::to_string),
        apart: proof.separate_pairs.iter().map(PairReport::from).collect(),
        meeting: proof.touching_pairs.iter().map(PairReport::from).collect(),
        ranges: proof.ranges,
        shape_pair_count: proof.shape_pair_count,
        region_count: proof.region_count,
    };
    json::print_json_or_text(args.json, &report, || format_proof(&proof, args.all))?;
    verdict.map_err(|clash| BuildError::from(clash).into())
}

fn format_proof(proof: &Proof, prints_all: bool) -> String {
    /// The largest number of rows in a list without --all.
    const MAX_ROWS: usize = 10;
    let format_list = |pairs: &[NearestPair]| {
        let close_pairs = pairs.iter().filter(|pair| pair.lower_bound < FAR_MM * 0.9);
        let rows: Vec<String> = close_pairs.map(format_row).collect();
        let max_rows = if prints_all { rows.len() } else { MAX_ROWS };
        match rows.len().saturating_sub(max_rows) {
            0 => rows.concat(),
            hidden_count => {
                let shown_rows = rows[..max_rows].concat();
                format!("{shown_rows}... and {hidden_count} more (--all)\n")
            }
        }
    };
    let mut text = String::new();
    text += "proved   seen   parts                                          at A1 A2 A3 A4, deg\n";
    text += "    mm     mm\n";
    text += &format_list(&proof.separate_pairs);
    text += "\ndesigned to touch: gap between the parts\n";
    text += &format_list(&proof.touching_pairs);
    text += "\nranges of the servo angles that the guard accepts\n";
    for (name, [min, max]) in SERVO_NAMES.iter().zip(proof.ranges) {
        _ = writeln!(text, "  {name} {min:7.2} to {max:7.2} deg");
    }
    let (pair_count, region_count) = (proof.shape_pair_count, proof.region_count);
    _ = writeln!(
        text,
        "{pair_count} pairs of shapes, {region_count} regions of poses"
    );
    if let (Ok(()), Some(nearest)) = (proof.check(), proof.separate_pairs.first()) {
        _ = writeln!(
            text,
            "no two parts come closer to each other than {:.2} mm at any pose that the guard accepts",
            nearest.lower_bound
        );
    }
    text
}

fn format_row(pair: &NearestPair) -> String {
    let witness = pair.witness.as_ref();
    let parts = format!("{}, {}", pair.first, pair.second);
    let seen = format_or_dash(witness.map(|clearance| clearance.mm), 2);
    let mut row = format!("{:6.2} {seen:>6}   {parts:<44}", pair.lower_bound);
    let pose = witness.map(|clearance| clearance.pose);
    for angle in pose.or(pair.unproved_angles).into_iter().flatten() {
        _ = write!(row, " {angle:6.1}");
    }
    row + "\n"
}
