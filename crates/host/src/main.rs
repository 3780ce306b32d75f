//! The entry point of the program `lizard`; the library `lizard_host` contains everything else.

use std::process::ExitCode;

fn main() -> ExitCode {
    lizard_host::commands::run_and_report(std::env::args_os().collect()).into()
}
