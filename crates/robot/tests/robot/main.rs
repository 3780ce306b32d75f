//! Integration tests of robot.toml and the gaits through the crate's public functions. Tests use robots/paper.toml
//! unless they name another robot.

use std::sync::LazyLock;

use lizard_core::numbers::gaits::Step;
use lizard_robot::{Body, CheckedGait, Error, GroundContact, Robot, Routine};

mod docs;
mod drives;
mod inputs;
mod mistakes;
mod predictions;
mod robots;
mod routines;
mod snapshots;
mod uneven_feet;

/// The path of the paper's robot.
const PAPER_PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/paper.toml");

/// Reads the text of robots/paper.toml.
fn paper_text() -> String {
    std::fs::read_to_string(PAPER_PATH).expect(PAPER_PATH)
}

/// The paper's robot, read once.
fn paper() -> &'static Robot {
    static ROBOT: LazyLock<Robot> =
        LazyLock::new(|| Robot::load(PAPER_PATH).unwrap_or_else(|error| panic!("{error}")));
    &ROBOT
}

/// Reads a table of texts. Each line has an input and its expected message, separated by ` => `; `\n` in an input
/// stands for a line break.
fn read_cases(table: &str) -> impl Iterator<Item = (String, &str)> {
    let rows = table.trim().lines().map(str::trim_start);
    let cases = rows.map(|row| row.split_once(" => ").expect(row));
    cases.map(|(input, message)| (input.replace(r"\n", "\n"), message))
}

/// The gait with this name, which must exist.
fn gait<'a>(robot: &'a Robot, name: &str) -> &'a CheckedGait {
    robot.gait(name).expect(name)
}

/// Returns kind, gait and count of each step record of a routine.
fn record_fields(routine: &Routine) -> Vec<(u8, u8, u16)> {
    let to_fields = |step: &Step| (step.kind, step.gait, step.count);
    routine.step_records().iter().map(to_fields).collect()
}

/// The body for which a separate implementation of the contact model computed the expected values.
const REFERENCE_BODY: Body = Body {
    mass: 307.0,
    ..Body::DEFAULT
};

/// Simulates the displacement over one cycle: mm forward, or deg of turn for a gait that turns on the spot.
fn simulate_movement(gait: &CheckedGait, ground: &GroundContact) -> f64 {
    let travel = gait.simulate_cycle(ground).travel;
    match gait.name() {
        "left" | "right" => travel.turn,
        _ => travel.forward,
    }
}

/// Asserts that a value differs from the expected value by less than a tolerance.
#[track_caller]
fn assert_near(label: &str, actual: f64, expected: f64, tolerance: f64) {
    let is_near = (actual - expected).abs() < tolerance;
    assert!(is_near, "{label}: {actual}, expected {expected}");
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
