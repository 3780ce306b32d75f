//! Tests of waits with a time limit: a wait that hangs fails with a message, and every other wait returns its result or
//! its own error.
#![cfg(unix)] // the tests start Unix programs

use std::io::ErrorKind;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::Command;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use lizard_time_limit::{TIME_LIMIT, TimeLimit};

const SHORT_LIMIT: TimeLimit = TimeLimit::new(Duration::from_millis(100));

/// Returns the message with which `wait` panics.
fn panic_message<T>(wait: impl FnOnce() -> T) -> String {
    let panic = catch_unwind(AssertUnwindSafe(wait)).err();
    let panic = panic.expect("the wait panics");
    match panic.downcast::<String>() {
        Ok(message) => *message,
        Err(panic) => (*panic.downcast::<&str>().expect("the panic has a message")).to_owned(),
    }
}

fn shell(script: &str) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", script]);
    command
}

#[test]
fn a_wait_for_a_condition_that_never_holds_names_the_event() {
    let message = panic_message(|| SHORT_LIMIT.wait_for("a reply", || false));
    assert_eq!(message, "waited 100ms for a reply");
    assert!(!SHORT_LIMIT.poll(|| false));
}

#[test]
fn a_condition_is_checked_until_it_holds() {
    let start = Instant::now();
    let mut check_count = 0;
    TIME_LIMIT.wait_for("the third check", || {
        check_count += 1;
        check_count == 3
    });
    assert_eq!(check_count, 3);
    assert!(TIME_LIMIT.poll(|| start.elapsed() > Duration::from_millis(20)));
}

#[test]
fn the_panic_of_a_task_that_blocks_names_the_event() {
    let (_sender, receiver) = mpsc::channel::<()>();
    let message = panic_message(|| SHORT_LIMIT.run("a message", move || receiver.recv()));
    assert_eq!(message, "waited 100ms for a message");
}

#[test]
fn a_task_that_ends_returns_its_result_or_fails_with_its_own_message() {
    assert_eq!(TIME_LIMIT.run("a sum", || 2 + 2), 4);
    let message = panic_message(|| TIME_LIMIT.run("a sum", || panic!("no sum")));
    assert_eq!(message, "no sum");
}

#[test]
fn a_program_that_does_not_exit_is_killed() {
    let child = Command::new("sleep").arg("60").spawn();
    let mut child = child.expect("the program starts");
    let status = SHORT_LIMIT.wait_for_exit(&mut child);
    let error = status.expect_err("the program sleeps");
    assert_eq!(error.kind(), ErrorKind::TimedOut);
    let message = format!("waited 100ms for the end of process {}", child.id());
    assert_eq!(error.to_string(), message);
    let status = child.try_wait().expect("the child exists");
    let status = status.expect("the child has ended");
    assert_eq!(status.code(), None, "killed by a signal");
}

#[test]
fn the_status_of_a_program_that_exits_is_returned() {
    let mut child = shell("exit 3").spawn().expect("the program starts");
    let status = TIME_LIMIT.wait_for_exit(&mut child);
    assert_eq!(status.expect("the program ends").code(), Some(3));
}

#[test]
fn a_program_gets_its_input_and_both_of_its_outputs_are_read() {
    // The input and the outputs are larger than a pipe's buffer.
    let input = vec![b'x'; 1 << 20];
    let output = TIME_LIMIT.run_command(&mut shell("tee /dev/stderr; exit 3"), &input);
    let output = output.expect("the program ends");
    assert!(output.stdout == input && output.stderr == input);
    assert_eq!(output.status.code(), Some(3));
}

#[test]
fn the_error_of_a_program_that_prints_forever_names_the_program() {
    let error = SHORT_LIMIT.run_command(&mut Command::new("yes"), b"");
    let error = error.expect_err("the program never ends");
    assert_eq!(error.kind(), ErrorKind::TimedOut);
    assert_eq!(error.to_string(), "waited 100ms for the end of `yes`");
}

#[test]
fn the_error_for_processes_that_a_program_leaves_running_names_the_program() {
    let error = SHORT_LIMIT.run_command(&mut shell("sleep 2 &"), b"");
    let message = error.expect_err("the process may still print").to_string();
    let expected = "waited 100ms for the end of a process started by `sh`";
    assert_eq!(message, expected);
}

#[test]
fn a_missing_program_is_reported_as_not_found() {
    let error = TIME_LIMIT.run_command(&mut Command::new("no-such-program"), b"");
    let error = error.expect_err("the program is missing");
    assert_eq!(error.kind(), ErrorKind::NotFound);
}
