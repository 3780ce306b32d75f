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

const PAPER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/paper.toml");

fn paper_text() -> String {
    std::fs::read_to_string(PAPER).expect(PAPER)
}

fn paper() -> &'static Robot {
    static ROBOT: LazyLock<Robot> =
        LazyLock::new(|| Robot::load(PAPER).unwrap_or_else(|error| panic!("{error}")));
    &ROBOT
}

fn gait<'a>(robot: &'a Robot, name: &str) -> &'a CheckedGait {
    robot.gait(name).expect(name)
}

/// The body for which another implementation of the contact model computed the expected figures.
const STUDIED_BODY: Body = Body {
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
fn paper_with(from: &str, to: &str) -> Result<Robot, Error> {
    let text = paper_text();
    assert!(text.contains(from), "robots/paper.toml has no {from:?}");
    Robot::parse(&text.replacen(from, to, 1))
}
