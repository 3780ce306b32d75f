//! The paper's subcommands as a person runs them: the program itself, its exit
//! codes, and the pages that it makes.

mod bad_input;
mod documents;
mod figures;
mod program;
mod solve;
