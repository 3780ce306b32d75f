//! Comparison of the contact model with MuJoCo, an independent physics engine.
//!
//! Every prediction of a path over the floor comes from this project's own contact model. A fault of that model would
//! affect every table, the page and the choice of gaits. So MuJoCo, which does not use the model, simulates the same
//! gaits of the robot that `lizard model` writes.
//!
//! `make physics` runs MuJoCo ([`mujoco`]), compares its displacements with the model's and with the stored ones in
//! `figures.json`, and prints all of them. The tables of the documentation are made from the stored figures
//! ([`Figures`], [`table`]), so a test without MuJoCo keeps the tables current.

pub mod assumptions;
mod case;
mod crossing;
mod expected;
mod figures;
pub mod grains;
pub mod mujoco;
pub mod pads;
pub mod servos;
pub mod surface;
mod table;
pub mod text;
mod walk;

pub use case::{Case, Feet, Legs};
pub use crossing::Crossing;
pub use expected::expected_table;
pub use figures::{Displacement, Figures, Results};
pub use table::{displacement_table, table};
pub use walk::{Walk, walks_of};

use std::path::PathBuf;

use lizard_robot::Robot;

/// The names of the files of robots/ that are compared, without their extension. `grain` has a table of its own
/// ([`grains`]).
pub const ROBOT_NAMES: [&str; 4] = ["paper", "own-gaits", "large", "unequal"];

/// Loads the robot of a file in robots/ by the file's name without the extension.
///
/// # Panics
/// If the file is missing or refused; tests of the robot crate show that every file is valid.
pub fn load_robot(name: &str) -> Robot {
    let file = crate_folder().join(format!("../../robots/{name}.toml"));
    Robot::load(file).expect(name)
}

/// Returns the folder of this crate.
pub fn crate_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}
