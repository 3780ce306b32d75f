//! `lizard`: the robot's mathematics and its simulation on the command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    lizard_host::commands::run_and_report(std::env::args_os().collect()).into()
}
