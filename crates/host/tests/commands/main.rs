//! Tests of the commands of `lizard` as a user runs them: the program itself, its exit codes, and the files and pages
//! that it writes.

mod another_robot;
mod draw;
mod flash;
mod measure;
mod merge;
mod model;
mod outputs;
mod paper;
mod parts;
mod program;
mod quickstart;
mod sim;
mod twin;
mod words;
