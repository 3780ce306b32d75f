//! Tests of the paper's subcommands as a user runs them: their output, their exit codes, and the pages in docs/ that
//! they make. Tests of figures use the paper's robot, robots/paper.toml; the others hold for any robot.toml.

mod bad_input;
mod documents;
mod figures;
mod solve;
