//! `lizard errata`: the comparison of every equation of the paper with the geometric solution.

use std::io::{self, Write as _};

use lizard_paper::errata::{Entry, SAMPLE_COUNT, equation_count, format_markdown, format_text};

use crate::Failure;
use crate::shared::json;
use crate::shared::progress::progress_bar;

/// Check which of the paper's equations hold
///
/// Each is evaluated at random poses (theta1, -theta5 in 90..180, theta4, -theta8 in 0..90; the
/// same poses on every run) and compared with the geometric solution, as printed and as
/// corrected. If the drawings suggest it, an equation is also tried with right-hand angles
/// measured clockwise from -x.
#[derive(clap::Args)]
#[command(after_help = "docs/errata.md is made by:
  lizard errata --markdown > docs/errata.md")]
pub struct Args {
    /// Number of random poses
    #[arg(long, default_value_t = SAMPLE_COUNT, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    samples: u32,
    /// Print the table as Markdown
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

/// Measures every equation and prints the table.
///
/// # Errors
/// Fails if the output cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let entries = measure(args.samples);
    let mut out = io::stdout().lock();
    if args.json {
        json::write_line(&mut out, &entries)?;
    } else if args.markdown {
        out.write_all(format_markdown(&entries, args.samples).as_bytes())?;
    } else {
        out.write_all(format_text(&entries, args.samples).as_bytes())?;
    }
    Ok(())
}

/// Measures every equation at `sample_count` random poses, with a progress bar.
fn measure(sample_count: u32) -> Vec<Entry> {
    let bar = progress_bar(equation_count(), "equations {bar:40} {pos}/{len}");
    let entries = lizard_paper::errata::measure(sample_count, &|| bar.inc(1));
    bar.finish_and_clear();
    entries
}
