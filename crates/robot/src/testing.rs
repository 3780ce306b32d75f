//! Helpers for unit tests, which read the robot files in robots/.

use crate::{Error, Robot};

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

/// Reads a robot from its file.
pub fn robot(name: &str) -> Robot {
    robot_with(name, &[]).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Reads all robots, each with the name of its file.
pub fn all_robots() -> impl Iterator<Item = (&'static str, Robot)> {
    ROBOT_NAMES.into_iter().map(|name| (name, robot(name)))
}

/// Reads the part of a robot's file before its first gait, `stand`, so that a test can append other gaits.
pub fn text_before_gaits(name: &str) -> String {
    let text = robot_text(name);
    let gaits_start = text
        .find("[gait.stand]")
        .expect("the file has the gait stand");
    text[..gaits_start].to_string()
}
