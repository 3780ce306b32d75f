//! Tests of the shell that runs programs for the flash tests. The shell passes input to the program, collects the
//! output, and ends the program on Ctrl-C.

mod shell;

use std::process::Command;

use lizard_time_limit::TIME_LIMIT;
use shell::Shell;

#[test]
fn ctrl_c_ends_a_command_that_reads_and_prints() {
    let mut shell = Shell::start("cat", &[], &[]);
    shell.type_line("a line");
    TIME_LIMIT.wait_for("the line to be printed", || shell.screen() == "a line\n");
    assert!(!shell.has_ended());
    shell.interrupt();
    assert!(shell.has_ended());
}

#[test]
fn ctrl_c_ends_a_command_even_if_the_test_process_ignores_sigint() {
    // If a shell without job control starts a program with `&`, the program ignores SIGINT. Programs in the tests'
    // shell must not inherit this signal disposition.
    let test_program = std::env::current_exe().expect("the path of the test program is known");
    let mut command = Command::new("env");
    command.args(["--ignore-signal=INT"]).arg(test_program);
    command.args(["--exact", "ctrl_c_ends_a_command_that_reads_and_prints"]);
    let output = TIME_LIMIT
        .run_command(&mut command, b"")
        .expect("the test program ends");
    let output_text = String::from_utf8_lossy(&output.stdout);
    assert!(output_text.contains("1 passed"), "{output_text}");
}
