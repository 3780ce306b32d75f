//! `lizard`: the robot's mathematics and its simulation on the command line.
#![forbid(unsafe_code)]

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use lizard_host::{bench, draw, gaits, paper, sim};

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
    Solve(paper::solve::Args),
    Inverse(paper::inverse::Args),
    Velocity(paper::velocity::Args),
    Singularity(paper::singularity::Args),
    Mobility(paper::mobility::Args),
    Design(paper::design::Args),
    Errata(paper::errata::Args),
    Charts(paper::charts::Args),
    Speed(paper::speed::Args),
    Sim(sim::Args),
    Draw(draw::Args),
    Bench(bench::Args),
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Gaits(args) => gaits::run(args),
        Command::Solve(args) => paper::solve::run(args),
        Command::Inverse(args) => paper::inverse::run(args),
        Command::Velocity(args) => paper::velocity::run(args),
        Command::Singularity(args) => paper::singularity::run(args),
        Command::Mobility(args) => paper::mobility::run(args),
        Command::Design(args) => paper::design::run(args),
        Command::Errata(args) => paper::errata::run(args),
        Command::Charts(args) => paper::charts::run(args),
        Command::Speed(args) => paper::speed::run(args),
        Command::Sim(args) => sim::run(args),
        Command::Draw(args) => draw::run(args),
        Command::Bench(args) => bench::run(args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) if failure.is_silent() => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("lizard: {failure}");
            ExitCode::from(failure.exit_code())
        }
    }
}
