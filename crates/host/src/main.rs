//! `lizard`: the robot's mathematics and its simulation on the command line.

use std::io::{self, Write};
use std::process::ExitCode;

use lizard_host::commands;
use lizard_host::readable_lines;

fn main() -> ExitCode {
    match commands::run(std::env::args_os().collect()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) if failure.is_silent() => ExitCode::SUCCESS,
        Err(failure) => {
            // It may quote a file or a board. A terminal that is gone is no reason to panic.
            let words = readable_lines(&failure.to_string());
            let _ = writeln!(io::stderr(), "lizard: {words}");
            ExitCode::from(failure.exit_code())
        }
    }
}
