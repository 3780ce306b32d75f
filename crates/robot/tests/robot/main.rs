//! Integration tests of robot.toml and the gaits through the crate's public functions. Tests that name no robot use
//! robots/paper.toml.

use std::sync::LazyLock;

use lizard_robot::{Body, CheckedGait, Error, Ground, Robot};

mod docs;
mod drives;
mod golden;
mod inputs;
mod predictions;
mod refusals;
mod robots;
mod routines;
mod standing;

/// The path of the paper's robot.
const PAPER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/paper.toml");

/// Reads the text of robots/paper.toml.
fn paper_text() -> String {
    std::fs::read_to_string(PAPER).expect(PAPER)
}

/// The paper's robot, read once.
fn paper() -> &'static Robot {
    static ROBOT: LazyLock<Robot> =
        LazyLock::new(|| Robot::load(PAPER).unwrap_or_else(|error| panic!("{error}")));
    &ROBOT
}

/// The gait with this name, which must exist.
fn gait<'a>(robot: &'a Robot, name: &str) -> &'a CheckedGait {
    robot.gait(name).expect(name)
}

/// The body for which a separate implementation of the contact model computed the expected figures.
const REFERENCE_BODY: Body = Body {
    mass: 307.0,
    ..Body::DEFAULT
};

/// Returns the movement of one cycle: forward in mm, or in deg for a gait that turns on the spot.
fn cycle_movement(gait: &CheckedGait, ground: &Ground) -> f64 {
    let travel = gait.simulate_cycle(ground).travel;
    match gait.name() {
        "left" | "right" => travel.turn,
        _ => travel.forward,
    }
}

/// Reads the paper's robot with one part of its file replaced.
fn paper_with(old: &str, new: &str) -> Result<Robot, Error> {
    let text = paper_text();
    assert!(text.contains(old), "robots/paper.toml has no {old:?}");
    Robot::parse(&text.replacen(old, new, 1))
}

/// Reads the paper's robot with further tables at the end of its text.
fn paper_with_tables(tables: &str) -> Result<Robot, Error> {
    Robot::parse(&format!("{}\n\n{tables}", paper_text().trim_end()))
}
