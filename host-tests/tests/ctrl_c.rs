//! Tests of the shell in which the flash tests run programs: it passes input on, shows output, and ends the program
//! at Ctrl-C.

mod shell;

use std::process::Command;

use lizard_time_limit::LIMIT;
use shell::Shell;

#[test]
fn ctrl_c_ends_a_command_that_reads_and_prints() {
    let mut shell = Shell::start("cat", &[], &[]);
    shell.say("a line");
    LIMIT.expect("the line, printed", || shell.screen() == "a line\n");
    assert!(!shell.has_ended());
    shell.interrupt();
    assert!(shell.has_ended());
}

#[test]
fn ctrl_c_ends_a_command_even_if_the_tests_ignore_it() {
    // A shell without job control starts a program with `&` so that it ignores SIGINT. The shell of the tests must
    // not inherit that.
    let test_program = std::env::current_exe().expect("it runs");
    let mut command = Command::new("env");
    command.args(["--ignore-signal=INT"]).arg(test_program);
    command.args(["--exact", "ctrl_c_ends_a_command_that_reads_and_prints"]);
    let output = LIMIT.output(&mut command, b"").expect("it ends");
    let output_text = String::from_utf8_lossy(&output.stdout);
    assert!(output_text.contains("1 passed"), "{output_text}");
}
