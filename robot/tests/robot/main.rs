//! robot.toml and the gaits, from the outside.

use std::sync::LazyLock;

use lizard_robot::{Gait, Robot};

mod docs;
mod golden;
mod predictions;
mod refusals;
mod source;
mod tables;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../robot.toml");

fn text() -> String {
    std::fs::read_to_string(FILE).expect("robot.toml")
}

fn robot() -> &'static Robot {
    static ROBOT: LazyLock<Robot> =
        LazyLock::new(|| Robot::load(FILE).expect("the project's own robot"));
    &ROBOT
}

fn gait<'a>(robot: &'a Robot, name: &str) -> &'a Gait {
    robot.gait(name).expect(name).1
}

/// The project's robot with one line of its file changed.
fn with(from: &str, to: &str) -> Result<Robot, lizard_robot::Error> {
    let text = text();
    assert!(text.contains(from), "robot.toml has no {from:?}");
    Robot::parse(&text.replacen(from, to, 1))
}
