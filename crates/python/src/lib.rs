//! The Rust part of the Python package `lizard`: passes numpy arrays to the Rust crates.
//!
//! The public classes are in `lizard/*.py`, which document the shapes and units of the arrays. Here, each row of a
//! two-dimensional array is a pose.
//!
//! # When not to use it
//! From Rust, use `lizard-kinematics` and `lizard-robot` directly.

mod board;
mod robot;

use pyo3::prelude::*;

/// The module `lizard._lizard`.
#[pymodule]
mod _lizard {
    use super::{Bound, PyModule, PyModuleMethods, PyResult};

    #[pymodule_export]
    use super::board::Board;
    #[pymodule_export]
    use super::robot::{Robot, RobotFileError};
    #[pymodule_export]
    use super::run_program;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        use lizard_kinematics::Check;
        let margins = Check::TYPE2.iter().chain(&Check::TYPE1).chain(&Check::LEG);
        let names: Vec<&str> = margins.map(|check| check.name()).collect();
        module.add("MARGINS", names)?;
        module.add("DEFAULT", include_str!("../../../robot.toml"))?;
        module.add("VERSION", env!("CARGO_PKG_VERSION"))
    }
}

/// Runs the program `lizard`, and returns its exit code.
#[pyfunction]
fn run_program(py: Python<'_>, arguments: Vec<String>) -> u8 {
    let arguments = arguments.into_iter().map(Into::into).collect();
    py.detach(|| lizard_host::commands::run_and_report(arguments))
}
