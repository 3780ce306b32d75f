//! Tests of the `lizard` commands as a user runs them: output, exit codes, written files, and the examples in docs/.

mod another_robot;
mod command_line;
mod draw;
mod flash;
mod harness;
mod measure;
mod merge;
mod model;
mod outputs;
mod paper;
mod parts;
mod quickstart;
mod sim;
mod twin;
