//! The core of a robotic lizard's firmware, for any such robot and any board.
//!
//! Four hobby servos drive two five-bar linkages; four dragging feet follow
//! them. A line of text asks for a gait or a pose; fifty times a second the
//! core turns what was asked for into four pulse widths that a servo can follow
//! and that no linkage of the robot can be broken by.
//!
//! Values move one way, each stage a plain value or struct that knows nothing
//! of the next:
//!
//! ```text
//! bytes -> Line -> Command -> Gait -> Clearance (guard) -> Pulses -> timer
//! ```
//!
//! Everything here is integer arithmetic and runs unchanged on the
//! microcontroller and on the host, where the tests compare it with floating
//! point. The numbers of a robot come through the trait [`robot::Robot`], the
//! board through the trait [`step::Board`]; this crate can name neither a
//! register nor a file.

#![no_std]
#![deny(unsafe_code)]
#![deny(missing_docs)]
#![warn(clippy::missing_errors_doc)]

#[cfg(any(test, feature = "host"))]
extern crate std;

pub mod adjustment;
pub mod answer;
pub mod calibration;
pub mod command;
pub mod console;
pub mod control;
pub mod couplers;
pub mod curve;
pub mod digits;
pub mod fault;
pub mod five_bar;
pub mod gait;
pub mod guard;
pub mod hazard;
pub mod kept;
pub mod limits;
pub mod line;
pub mod memory;
pub mod motion;
pub mod order;
pub mod part;
pub mod point_to_point;
pub mod pose;
pub mod record;
pub mod refusal;
pub mod restart;
pub mod robot;
pub mod root;
pub mod safety;
#[cfg(test)]
mod sample;
pub mod settings;
pub mod slider;
pub mod step;
pub mod supervisor;
pub mod supply;
pub mod text;
pub mod trig;
pub mod units;
#[cfg(any(test, feature = "host"))]
pub mod virtual_board;
pub mod word;
