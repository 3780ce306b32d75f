//! `lizard prove`: compares the integer guard with floating point at every pair of positions of two servos.

use std::fmt::Write as _;

use lizard_proof::{GuardComparison, LENGTH_BAND_STEPS, PIECE_COUNT, PairSample, Proof};
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::shared::json;
use crate::shared::number::{format_or_dash, group_digits, whole_number_parser};
use crate::shared::progress::create_progress_bar;
use crate::shared::spread::{SpreadArgs, Spreadable};

/// Compare the firmware's guard with floating point at every possible pose.
///
/// Every condition of a safe pose depends on one servo or on two. The command therefore
/// checks every pair of positions of the two servos at the head, the tail, the left and the
/// right side, in the firmware's steps of 1/65536 turn. It decides each pair both with the
/// firmware's integers and in floating point. In certified cells, where the firmware skips
/// the guard, the guard must accept every pair. The command prints the largest error of each
/// margin (at head and tail, only at pairs whose type-2 margin is above its limit), and the largest
/// distance from a limit at which the two decisions differ. The exit code is 1 if that distance
/// exceeds the one in docs/firmware.md, or if the guard rejects a pair in a certified cell.
#[derive(clap::Args, Debug, Serialize, Deserialize)]
#[command(after_help = "Examples:
  lizard prove
  lizard prove --robot robots/unequal.toml
  lizard prove --one-in 64 --offset 5")]
pub struct Args {
    /// Check only one pair in N, at even intervals
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole_number_parser::<u32>(1, 1_000_000))]
    one_in: u32,
    /// Offset of the selected pairs, less than N; each offset selects different pairs
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = whole_number_parser::<u32>(0, 1_000_000))]
    offset: u32,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    #[serde(skip)]
    spread: SpreadArgs,
}

impl Spreadable for Args {
    const COMMAND: &'static str = "prove";

    fn spread_args(&mut self) -> &mut SpreadArgs {
        &mut self.spread
    }
}

/// Compares the guard with floating point and prints the result.
///
/// # Errors
/// Fails if the offset is too large, if robot.toml is invalid, if the output cannot be written, or if the guard decides
/// a pose wrongly.
pub fn run(args: Args) -> Result<(), Failure> {
    if args.offset >= args.one_in {
        return Err(Failure::Input(format!(
            "--offset is {}, but must be less than --one-in, which is {}",
            args.offset, args.one_in
        )));
    }
    let robot = args.spread.robot.load()?;
    let guard = robot.firmware();
    let sample = PairSample {
        one_in: args.one_in,
        offset: args.offset,
    };
    let own_piece_count = args.spread.count_own_pieces(PIECE_COUNT) as u64;
    let row_count = Proof::row_count(guard) * own_piece_count / PIECE_COUNT as u64;
    let template = "{bar:40} {percent} % of all rows, {eta} left";
    let bar = create_progress_bar(row_count as usize, template);
    let comparison = GuardComparison::new(&robot, guard, sample);
    let check_piece =
        |index| comparison.compare_piece(index, &|checked_rows| bar.inc(checked_rows));
    let pieces = args.spread.run_pieces(&args, PIECE_COUNT, check_piece)?;
    bar.finish_and_clear();
    let Some(pieces) = pieces else {
        return Ok(());
    };
    let proof = Proof::from_tallies(&robot, guard, pieces);

    json::print_json_or_text(args.json, &proof, || format_report(&proof, sample))?;
    match proof.wrong_count() {
        0 => Ok(()),
        wrong_count => Err(Failure::Operation(format!(
            "the guard decides {wrong_count} pairs wrongly that are in a certified cell or farther \
             from a limit than the allowed distance"
        ))),
    }
}

fn format_report(proof: &Proof, sample: PairSample) -> String {
    let mut text =
        "                                        largest error          decisions differ within\n\
         part        servos          pairs type-2/leg   type-1      mm    margin      mm   wrong\n"
            .to_owned();
    for finding in &proof.findings {
        let tally = &finding.tally;
        _ = writeln!(
            text,
            "{:<11} {:<7} {:>13} {:>10} {:>8} {:>7} {:>9} {:>7} {:>7}",
            finding.part,
            finding.servos.join(" "),
            group_digits(tally.pair_count as f64, 0),
            format_or_dash(tally.max_type2_error.or(tally.max_leg_error), 5),
            format_or_dash(tally.max_type1_error, 5),
            format_or_dash(tally.max_slider_error, 4),
            format_or_dash(tally.max_margin_difference, 6),
            format_or_dash(tally.max_length_difference, 4),
            tally.wrong_count
        );
    }
    for finding in &proof.findings {
        if let Some(example) = &finding.tally.example {
            _ = writeln!(text, "{}: {example}", finding.part);
        }
    }
    let sample_text = match sample.one_in {
        1 => "every pair of positions".to_string(),
        one_in => format!("one pair of positions in {one_in}"),
    };
    _ = writeln!(
        text,
        "\n{sample_text}, in steps of 0.0055 deg, of the robot whose numbers have the hash {:08x}",
        proof.hash
    );
    if proof.wrong_count() == 0 {
        let certified_count = group_digits(proof.certified_count() as f64, 0);
        _ = writeln!(
            text,
            "the guard decides every pose correctly that is more than {:.4} (a sine) or {LENGTH_BAND_STEPS} length steps from a limit",
            proof.margin_band
        );
        _ = writeln!(
            text,
            "the guard accepts all {certified_count} pairs in the robot's cells, where the firmware skips the guard"
        );
    }
    text
}
