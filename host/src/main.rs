//! `lizard`: the robot's mathematics and its simulation on the command line.

#[cfg(not(all(
    feature = "simulator",
    feature = "paper",
    feature = "console",
    feature = "parts"
)))]
use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
#[cfg(not(all(
    feature = "simulator",
    feature = "paper",
    feature = "console",
    feature = "parts"
)))]
use lizard_host::absent;
#[cfg(all(feature = "simulator", feature = "parts"))]
use lizard_host::mjcf;
#[cfg(feature = "parts")]
use lizard_host::parts;
use lizard_host::plain::plain_lines;
#[cfg(all(feature = "simulator", feature = "paper"))]
use lizard_host::tune;
#[cfg(feature = "simulator")]
use lizard_host::{bench, sim, twin};
use lizard_host::{completions, draw, gaits, groups, spring};
#[cfg(feature = "console")]
use lizard_host::{console, flash};
#[cfg(feature = "paper")]
use lizard_host::{paper, prove};

/// Compute, check, draw and simulate the four-servo robotic lizard.
///
/// Angles are degrees in the chassis frame: x to the robot's right, y forward,
/// counter-clockwise from +x, seen from above. Lengths are mm. Servos are A1 =
/// theta1 (front left), A2 = theta4 (front right), A3 = theta8 (back right), A4 =
/// theta5 (back left).
///
/// Exit codes: 0 done, 1 it could not be done, 2 the input is wrong.
#[derive(Parser)]
#[command(name = "lizard", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Gaits(gaits::Args),
    #[cfg(feature = "paper")]
    #[command(visible_alias = "fk")]
    Solve(paper::solve::Args),
    #[cfg(feature = "paper")]
    #[command(visible_alias = "ik")]
    Inverse(paper::inverse::Args),
    #[cfg(feature = "paper")]
    #[command(visible_alias = "jacobian")]
    Velocity(paper::velocity::Args),
    #[cfg(feature = "paper")]
    Singularity(paper::singularity::Args),
    #[cfg(feature = "paper")]
    Mobility(paper::mobility::Args),
    #[cfg(feature = "paper")]
    Design(paper::design::Args),
    #[cfg(feature = "paper")]
    Errata(paper::errata::Args),
    #[cfg(feature = "paper")]
    Charts(paper::charts::Args),
    #[cfg(feature = "paper")]
    Speed(paper::speed::Args),
    #[cfg(feature = "paper")]
    Prove(prove::Args),
    #[cfg(feature = "simulator")]
    Sim(sim::Args),
    #[cfg(feature = "simulator")]
    Twin(twin::Args),
    #[cfg(all(feature = "simulator", feature = "paper"))]
    Tune(tune::Args),
    Draw(draw::Args),
    #[cfg(feature = "parts")]
    Parts(parts::Args),
    #[cfg(feature = "parts")]
    Fit(parts::fit::Args),
    #[cfg(all(feature = "simulator", feature = "parts"))]
    Mjcf(mjcf::Args),
    Spring(spring::Args),
    #[cfg(feature = "simulator")]
    Bench(bench::Args),
    #[cfg(feature = "console")]
    Flash(flash::Args),
    #[cfg(feature = "console")]
    #[command(visible_alias = "monitor")]
    Console(console::interactive::ConsoleArgs),
    #[cfg(feature = "console")]
    Calibrate(console::calibrate::Args),
    #[cfg(feature = "console")]
    Backup(console::backup::BackupArgs),
    #[cfg(feature = "console")]
    Restore(console::backup::RestoreArgs),
    #[cfg(feature = "console")]
    Record(console::interactive::RecordArgs),
    #[cfg(all(feature = "console", feature = "simulator"))]
    Replay(console::replay::Args),
    Completions(completions::CompletionsArgs),
    Man(completions::ManArgs),
    /// A command that this build may lack.
    #[cfg(not(all(
        feature = "simulator",
        feature = "paper",
        feature = "console",
        feature = "parts"
    )))]
    #[command(external_subcommand)]
    Other(Vec<OsString>),
}

/// All commands and options, the commands in groups.
fn program() -> clap::Command {
    groups::grouped(Cli::command())
}

fn main() -> ExitCode {
    let mut matches = program().get_matches();
    let cli = Cli::from_arg_matches_mut(&mut matches).unwrap_or_else(|error| error.exit());
    let done = match cli.command {
        Command::Gaits(args) => gaits::run(args),
        #[cfg(feature = "paper")]
        Command::Solve(args) => paper::solve::run(args),
        #[cfg(feature = "paper")]
        Command::Inverse(args) => paper::inverse::run(args),
        #[cfg(feature = "paper")]
        Command::Velocity(args) => paper::velocity::run(args),
        #[cfg(feature = "paper")]
        Command::Singularity(args) => paper::singularity::run(args),
        #[cfg(feature = "paper")]
        Command::Mobility(args) => paper::mobility::run(args),
        #[cfg(feature = "paper")]
        Command::Design(args) => paper::design::run(args),
        #[cfg(feature = "paper")]
        Command::Errata(args) => paper::errata::run(args),
        #[cfg(feature = "paper")]
        Command::Charts(args) => paper::charts::run(args),
        #[cfg(feature = "paper")]
        Command::Speed(args) => paper::speed::run(args),
        #[cfg(feature = "paper")]
        Command::Prove(args) => prove::run(args),
        #[cfg(feature = "simulator")]
        Command::Sim(args) => sim::run(args),
        #[cfg(feature = "simulator")]
        Command::Twin(args) => twin::run(args),
        #[cfg(all(feature = "simulator", feature = "paper"))]
        Command::Tune(args) => tune::run(args),
        Command::Draw(args) => draw::run(args),
        #[cfg(feature = "parts")]
        Command::Parts(args) => parts::run(args),
        #[cfg(feature = "parts")]
        Command::Fit(args) => parts::fit::run(args),
        #[cfg(all(feature = "simulator", feature = "parts"))]
        Command::Mjcf(args) => mjcf::run(args),
        Command::Spring(args) => spring::run(args),
        #[cfg(feature = "simulator")]
        Command::Bench(args) => bench::run(args),
        #[cfg(feature = "console")]
        Command::Flash(args) => flash::run(args),
        #[cfg(feature = "console")]
        Command::Console(args) => console::interactive::console(args),
        #[cfg(feature = "console")]
        Command::Calibrate(args) => console::calibrate::run(args),
        #[cfg(feature = "console")]
        Command::Backup(args) => console::backup::backup(args),
        #[cfg(feature = "console")]
        Command::Restore(args) => console::backup::restore(args),
        #[cfg(feature = "console")]
        Command::Record(args) => console::interactive::record(args),
        #[cfg(all(feature = "console", feature = "simulator"))]
        Command::Replay(args) => console::replay::run(args),
        Command::Completions(args) => completions::completions(args, program()),
        Command::Man(args) => completions::man(args, program()),
        #[cfg(not(all(
            feature = "simulator",
            feature = "paper",
            feature = "console",
            feature = "parts"
        )))]
        Command::Other(words) => Err(absent::explain(&words)),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) if failure.is_silent() => ExitCode::SUCCESS,
        Err(failure) => {
            // It may quote a file or a board. A terminal that is gone is no reason to panic.
            let words = plain_lines(&failure.to_string());
            let _ = writeln!(io::stderr(), "lizard: {words}");
            ExitCode::from(failure.exit_code())
        }
    }
}
