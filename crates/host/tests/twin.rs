//! `lizard twin` on wrong input.

use std::path::Path;
use std::process::{Command, Output};

use lizard_time_limit::LIMIT;

/// The paper's robot: what these tests say is its.
const PAPER: &str = concat!(
    "--robot=",
    env!("CARGO_MANIFEST_DIR"),
    "/../../robots/paper.toml"
);

fn lizard(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(arguments);
    if !arguments.iter().any(|word| word.starts_with("--robot=")) {
        command.arg(PAPER);
    }
    command.current_dir(Path::new(env!("CARGO_TARGET_TMPDIR")));
    LIMIT.output(&mut command, b"").expect("the program runs")
}

fn complaint(arguments: &[&str]) -> String {
    let output = lizard(arguments);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty(), "nothing is half written");
    String::from_utf8_lossy(&output.stderr).trim().to_owned()
}

#[test]
fn a_gait_that_there_is_not_is_refused_with_those_there_are() {
    assert_eq!(
        complaint(&["twin", "--gait", "jump"]),
        "lizard: robot.toml has no gait `jump`; those that move are walk, trot, crawl, back, left, right, arc-left, arc-right, look"
    );
    assert_eq!(
        complaint(&["twin", "--gait", "stand"]),
        "lizard: the gait `stand` moves no servo"
    );
}
