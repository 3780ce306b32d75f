//! `lizard errata`: compares every equation of the paper with the geometric solution.
//! Only the equations are typed in; everything else in the table is computed.

mod equation;
mod forward;
mod inverse;
mod legs;
mod sample;
mod singular;
mod synthesis;

use std::fmt::Write as _;
use std::io::{self, Write as _};

use indicatif::ParallelProgressIterator;
use rayon::prelude::*;
use serde::Serialize;

use crate::Failure;
use crate::shared::json;
use crate::shared::progress::progress_bar;
use equation::{Equation, Misses};
use sample::Sample;

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
    #[arg(long, default_value_t = SAMPLES, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    samples: u32,
    /// Print the table as Markdown
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

/// Number of random poses behind docs/errata.md.
pub const SAMPLES: u32 = 20_000;

/// An equation with its measured errors.
#[derive(Serialize)]
pub struct Entry {
    place: &'static str,
    printed: &'static str,
    holds: bool,
    /// The largest error, in `unit`.
    worst: f64,
    /// Share of the samples at which the printed form has no real value.
    unreal: f64,
    unit: &'static str,
    /// The largest error of the printed form in a special case, in `unit`, and the name of that case; null without
    /// one.
    aside: Option<(f64, &'static str)>,
    /// True if the printed form holds with right-hand angles measured clockwise from -x; null if
    /// the drawings do not suggest that reading.
    holds_clockwise: Option<bool>,
    corrected: Option<&'static str>,
    corrected_worst: Option<f64>,
    corrected_holds: Option<bool>,
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
        out.write_all(markdown(&entries, args.samples).as_bytes())?;
    } else {
        out.write_all(text(&entries, args.samples).as_bytes())?;
    }
    Ok(())
}

/// Measures every equation, in the paper's order, at `samples` random poses.
pub fn measure(samples: u32) -> Vec<Entry> {
    let samples: Vec<Sample> = Sample::many(samples as usize).collect();
    let equations: Vec<&Equation> = [
        synthesis::EQUATIONS,
        inverse::EQUATIONS,
        forward::EQUATIONS,
        legs::EQUATIONS,
        singular::EQUATIONS,
    ]
    .into_iter()
    .flatten()
    .collect();
    let progress = progress_bar(equations.len(), "equations {bar:40} {pos}/{len}");
    let entries = equations
        .into_par_iter()
        .progress_with(progress.clone())
        .map(|equation| {
            let printed = Misses::of(equation.miss, &samples);
            let corrected = equation
                .corrected
                .map(|(_, miss)| Misses::of(miss, &samples));
            Entry {
                place: equation.place,
                printed: equation.printed,
                holds: printed.holds(),
                worst: printed.worst,
                unreal: printed.unreal,
                unit: equation.unit,
                aside: equation
                    .special_case
                    .map(|(place, miss)| (Misses::of(miss, &samples).worst, place)),
                holds_clockwise: equation
                    .clockwise
                    .map(|miss| Misses::of(miss, &samples).holds()),
                corrected: equation.corrected.map(|(form, _)| form),
                corrected_worst: corrected.map(|misses| misses.worst),
                corrected_holds: corrected.map(|misses| misses.holds()),
            }
        })
        .collect();
    progress.finish_and_clear();
    entries
}

impl Entry {
    /// The verdict in words.
    fn verdict(&self) -> &'static str {
        match (self.holds, self.holds_clockwise) {
            (true, Some(false)) => "holds, but not clockwise",
            (true, _) => "holds",
            (false, Some(true)) => "fails; holds clockwise",
            (false, _) => "fails",
        }
    }

    /// The largest error in words, or `rounding` if the equation holds, followed by the error of the special case.
    fn format_error(&self) -> String {
        let mut text = self.plain_miss();
        if let Some((worst_error, place)) = self.aside {
            let unit = self.unit;
            let _ = write!(
                text,
                "; {} {unit} at {place}",
                format_three_digits(worst_error)
            );
        }
        text
    }

    /// The largest error in words, or `rounding` if the equation holds, without the special case.
    fn plain_miss(&self) -> String {
        if self.holds {
            return "rounding".to_string();
        }
        let mut text = format!("{} {}", format_three_digits(self.worst), self.unit);
        if self.unreal >= 0.999_95 {
            text = "no real value".to_string();
        } else if self.unreal > 0.0 {
            let _ = write!(
                text,
                ", no real value at {:.0} % of poses",
                100.0 * self.unreal
            );
        }
        text
    }

    /// True if the printed or the corrected form holds.
    pub fn is_settled(&self) -> bool {
        self.holds || self.corrected_holds == Some(true)
    }
}

/// Formats a value with three significant digits, without an exponent.
fn format_three_digits(value: f64) -> String {
    let digits = (2 - value.abs().max(1e-9).log10().floor() as i32).clamp(0, 9);
    format!("{value:.0$}", digits as usize)
}

fn text(entries: &[Entry], samples: u32) -> String {
    let holding_count = entries.iter().filter(|entry| entry.holds).count();
    let mut page = format!(
        "{} printed equations at {samples} random poses: {holding_count} hold, {} do not.\n",
        entries.len(),
        entries.len() - holding_count
    );
    for entry in entries {
        let mark = if entry.holds { "holds" } else { "FAILS" };
        let _ = write!(
            page,
            "\n{mark}  {}\n       printed    {}\n",
            entry.place, entry.printed
        );
        if !entry.holds || entry.aside.is_some() {
            let _ = writeln!(page, "       worst      {}", entry.format_error());
        }
        match entry.holds_clockwise {
            Some(true) => page += "       clockwise  holds\n",
            Some(false) => page += "       clockwise  fails\n",
            None => {}
        }
        if let (Some(form), Some(is_correct)) = (entry.corrected, entry.corrected_holds) {
            let verdict = if is_correct { "holds" } else { "fails" };
            let _ = writeln!(page, "       corrected  {form}: {verdict}");
        }
    }
    page
}

/// The text of docs/errata.md.
pub fn markdown(entries: &[Entry], samples: u32) -> String {
    let holding_count = entries.iter().filter(|entry| entry.holds).count();
    let mut page = format!(
        "# Errata of the paper, measured

Made by `lizard errata --markdown`; a test fails when it is out of date. Nothing
here is typed in but the equations themselves.

Each printed equation of *Optimal Kinematic Design of a Robotic Lizard using
Four-Bar and Five-Bar Mechanisms* was evaluated at {samples} random poses (theta1 and
-theta5 in 90 to 180, theta4 and -theta8 in 0 to 90 degrees, the paper's lengths)
and compared with the geometric solution, whose loops close within 1e-9 mm. Angles
are counter-clockwise from +x in the chassis frame throughout. \"Clockwise\" is a
second reading, in which the angles of the right-hand links are measured clockwise
from -x, as the drawings suggest: then several signs come out right, but the loop
equations and the theta3 formula, which the paper uses with them, do not. A miss below 1e-6 in
its unit counts as rounding.

**{holding_count} of {} hold as printed.** Every corrected form below was measured at the same
poses and holds.

| where | printed | verdict | worst miss | corrected |
|---|---|---|---|---|
",
        entries.len()
    );
    let escape_cell = |text: &str| text.replace('|', "\\|");
    for entry in entries {
        let corrected = match (entry.corrected, entry.corrected_holds) {
            (Some(form), Some(true)) => escape_cell(form),
            (Some(form), _) => format!("{} (fails too)", escape_cell(form)),
            _ => "-".to_string(),
        };
        let _ = writeln!(
            page,
            "| {} | {} | {} | {} | {corrected} |",
            escape_cell(entry.place),
            escape_cell(entry.printed),
            entry.verdict(),
            escape_cell(&entry.format_error())
        );
    }
    page
}
