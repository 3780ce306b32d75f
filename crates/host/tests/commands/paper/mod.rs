//! Tests of the paper's commands: their output, their exit codes, and the pages in docs/ that they write. Tests of
//! values use the paper's robot, robots/paper.toml; the other tests hold for any robot.toml.

mod bad_input;
mod docs;
mod pose;
mod values;

/// The header of a list of poses.
const HEADER: &str = "theta1,theta4,theta8,theta5\n";
