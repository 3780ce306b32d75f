//! Helpers for unit tests: robots from the files in robots/, and assertions.

use crate::{CheckedGait, Error, Robot};

/// Names of the files in robots/, without `.toml`.
pub const ROBOT_NAMES: [&str; 5] = ["paper", "large", "unequal", "own-gaits", "grain"];

/// Reads the text of a robot's file.
pub fn robot_text(name: &str) -> String {
    let path = format!("{}/../../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).expect(&path)
}

/// Parses a robot's file after replacing texts in it, each at its first occurrence.
pub fn robot_with(name: &str, changes: &[(&str, &str)]) -> Result<Robot, Error> {
    let mut text = robot_text(name);
    for (old, new) in changes {
        assert!(text.contains(old), "{name}.toml has no {old:?}");
        text = text.replacen(old, new, 1);
    }
    Robot::parse(&text)
}

/// Parses the paper's robot with further tables at the end of its text.
pub fn paper_with_tables(tables: &str) -> Result<Robot, Error> {
    Robot::parse(&format!("{}\n{tables}", robot_text("paper")))
}

/// Parses a robot's file as [`robot_with`] does. The changed robot must be valid.
pub fn valid_robot_with(name: &str, changes: &[(&str, &str)]) -> Robot {
    robot_with(name, changes).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Returns the error message of a robot's file that the changes make invalid.
pub fn error_with(name: &str, changes: &[(&str, &str)]) -> String {
    let Err(error) = robot_with(name, changes) else {
        panic!("{name} is valid in spite of {changes:?}");
    };
    error.to_string()
}

/// Reads a robot from its file.
pub fn robot(name: &str) -> Robot {
    valid_robot_with(name, &[])
}

/// Reads all robots, each with the name of its file.
pub fn all_robots() -> impl Iterator<Item = (&'static str, Robot)> {
    ROBOT_NAMES.into_iter().map(|name| (name, robot(name)))
}

/// Runs a test for every gait of all robots, with a label of the robot and the gait for messages.
pub fn for_each_gait(test: impl Fn(&str, &Robot, &CheckedGait)) {
    for (name, robot) in all_robots() {
        for gait in robot.gaits() {
            test(&format!("{name} {}", gait.name()), &robot, gait);
        }
    }
}

/// Checks that `text` contains `expected`.
#[track_caller]
pub fn assert_contains(text: &str, expected: &str) {
    assert!(text.contains(expected), "expected {expected:?}: {text}");
}

/// Checks that `text` starts with `expected`.
#[track_caller]
pub fn assert_starts_with(text: &str, expected: &str) {
    assert!(text.starts_with(expected), "expected {expected:?}: {text}");
}

/// Checks that a value differs from the expected value by less than a tolerance.
#[track_caller]
pub fn assert_near(actual: f64, expected: f64, tolerance: f64) {
    let is_near = (actual - expected).abs() < tolerance;
    assert!(is_near, "{actual}, expected {expected}");
}

/// Reads a table of texts: one row in each line, whose cells are separated by ` | `.
pub fn read_table<const N: usize>(table: &str) -> impl Iterator<Item = [&str; N]> {
    let rows = table.trim().lines().map(str::trim_start);
    rows.map(|row| {
        let cells: Vec<&str> = row.split(" | ").collect();
        cells.try_into().expect(row)
    })
}

/// Reads the part of a robot's file before its first gait, `stand`, so that a test can append other gaits.
pub fn text_before_gaits(name: &str) -> String {
    let text = robot_text(name);
    let (text_before, _) = text.split_once("[gait.stand]").expect(name);
    text_before.to_string()
}
