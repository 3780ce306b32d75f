//! Compares the contact model with two engines that others wrote.
//!
//! Every prediction of a path over the floor comes from this project's own contact model.
//! A fault of that model would affect every table, the page and the choice of gaits. So
//! rapier and MuJoCo walk the same gaits: rapier with a chassis and four dragging balls,
//! MuJoCo with the robot as `lizard mjcf` writes it. Neither uses the model.
//!
//! `make physics` runs both (`rapier`, `mujoco`), compares them with the model and with
//! the figures in `figures.json`, and prints all of it. The tables of the documentation
//! are made from the stored figures ([`Figures`], [`table`]), so a test without engines
//! keeps them current.

mod case;
mod expected;
mod figures;
#[cfg(feature = "engines")]
pub mod mujoco;
#[cfg(feature = "engines")]
pub mod rapier;
mod row;
mod table;

pub use case::{Case, Feet, Legs};
pub use expected::expected;
pub use figures::{Figures, Said, Way};
pub use row::{Row, rows};
pub use table::{spread, table};

use std::path::PathBuf;

use lizard_robot::Robot;

/// The files of robots/ by their names without an ending.
pub const ROBOTS: [&str; 4] = ["paper", "own-gaits", "large", "unequal"];

/// One of them.
///
/// # Panics
/// Where it is wrong; tests of the robot crate hold that none is.
#[must_use]
pub fn robot(name: &str) -> Robot {
    let file = here().join(format!("../robots/{name}.toml"));
    Robot::load(file).expect(name)
}

/// The folder of this crate.
#[must_use]
pub fn here() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}
