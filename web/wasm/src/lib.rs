//! Everything that the page computes about its robot. This crate has almost no formulas of its own; it calls the
//! project's other crates.
//!
//! The page passes the text of a robot.toml and then, fifty times per second, the four pulse widths at a UNO's pins. It
//! receives the position of every joint, the margin to every singularity, the limit that the pose violates, if any, and
//! the body's place on the floor. `PageState` holds the robot and its place; [`PageRobot`] is its JavaScript class,
//! `Robot`.
//!
//! # When not to use it
//! The interface is made for this page and changes with it. A Rust program uses `lizard-robot` and `lizard-twin`
//! directly; another page can take [`PageRobot`] as an example.

mod calibration;
mod description;
mod drawn_gait;
mod floor;
#[cfg(feature = "tune")]
mod gait_search;
mod javascript;
mod lengths;
mod page;
#[cfg(test)]
mod paper;
mod place;
mod prediction;
mod refusal;
mod reports;
mod round_path;
mod running_core;
mod scene;
mod singularity_map;
mod trial;
mod workspace;

pub use javascript::PageRobot;
