//! The paper's subcommands as a person runs them: the program itself, its exit
//! codes, and the pages that it makes. Tests of figures use the paper's robot,
//! robots/paper.toml; the others hold for any robot.toml.

mod bad_input;
mod documents;
mod figures;
mod solve;
