//! The shell of the tests that flash: what they type is read, what is printed is seen,
//! and Ctrl-C ends it wherever these tests run.

mod shell;

use std::process::Command;

use lizard_time_limit::LIMIT;
use shell::Shell;

#[test]
fn ctrl_c_ends_a_command_that_reads_and_prints() {
    let mut shell = Shell::start("cat", &[], &[]);
    shell.say("a line");
    LIMIT.until("the line, printed", || shell.screen() == "a line\n");
    assert!(!shell.has_ended());
    shell.interrupt();
    assert!(shell.has_ended());
}

#[test]
fn ctrl_c_ends_a_command_though_these_tests_ignore_it() {
    // As what a shell without job control starts with `&` does.
    let this = std::env::current_exe().expect("it runs");
    let mut again = Command::new("env");
    again.args(["--ignore-signal=INT"]).arg(this);
    again.args(["--exact", "ctrl_c_ends_a_command_that_reads_and_prints"]);
    let output = LIMIT.output(&mut again, b"").expect("it ends");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("1 passed"), "{said}");
}
