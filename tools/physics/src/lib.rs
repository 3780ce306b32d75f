//! Comparison of the contact model with MuJoCo, an independent physics engine.
//!
//! Every prediction of a path over the floor comes from this project's own contact model. A fault in this model would
//! affect every table, the page and the choice of gaits. Therefore MuJoCo simulates the same gaits with the robot that
//! `lizard model` writes, without using the contact model.
//!
//! `make physics` runs MuJoCo ([`mujoco`]), compares its displacements with the model's and with the stored ones in
//! this crate's JSON files, and prints all displacements. The tables in the documentation come from the stored results
//! ([`WalkResults`], [`format_comparison_table`]). Therefore a test without MuJoCo keeps the tables current.

pub mod assumptions;
mod case;
mod crossing;
mod expected;
pub mod grains;
pub mod mujoco;
pub mod pads;
mod results;
pub mod servos;
pub mod surface;
mod table;
pub mod text;
mod walk;

pub use case::{Case, FootSetup, LegDrive};
pub use crossing::Crossing;
pub use expected::format_expected_results_table;
pub use results::{Displacement, DisplacementPair, GroupedDisplacements, WalkResults};
pub use table::{Component, format_comparison_table, format_displacement_table};
pub use walk::{Walk, list_walks};

use std::path::PathBuf;

use lizard_robot::Robot;

/// The names of the compared files in robots/, without their extension. `grain` has a separate table ([`grains`]).
pub const ROBOT_NAMES: [&str; 4] = ["paper", "own-gaits", "large", "unequal"];

/// Loads the robot from a file in robots/; `name` is the file's name without the extension.
///
/// # Panics
/// If the file is missing or invalid; tests of the robot crate show that every file is valid.
pub fn load_robot(name: &str) -> Robot {
    let path = crate_dir().join(format!("../../robots/{name}.toml"));
    Robot::load(path).expect(name)
}

/// Loads the paper's robot with some texts of its file replaced, each where it first occurs. `description` names the
/// change in error messages.
///
/// # Panics
/// If a text to replace is not in robots/paper.toml, or if the changed robot is invalid.
fn load_changed_paper(description: &str, replacements: &[(&str, &str)]) -> Robot {
    let text = std::fs::read_to_string(crate_dir().join("../../robots/paper.toml"));
    let mut text = text.expect("robots/paper.toml is readable");
    for &(old, new) in replacements {
        assert!(text.contains(old), "robots/paper.toml has no {old:?}");
        text = text.replacen(old, new, 1);
    }
    Robot::parse(&text).expect(description)
}

/// Returns the folder of this crate.
pub fn crate_dir() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}
