//! The portable core of the robotic lizard's firmware.
//!
//! Four hobby servos drive two five-bar linkages; four dragging feet follow
//! them. A line of text asks for a gait or a pose; fifty times a second the
//! core turns that wish into four pulse widths that a servo can follow and
//! that no linkage of the robot can be broken by.
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
//! point. Registers, interrupts and the timer live in the binary (`board`);
//! this library cannot name them.

#![no_std]
#![deny(unsafe_code)]
#![deny(missing_docs)]

pub mod answer;
pub mod clearance;
pub mod command;
pub mod console;
pub mod fivebar;
pub mod gait;
pub mod hazard;
pub mod line;
pub mod motion;
pub mod pose;
pub mod robot;
pub mod root;
pub mod slider;
pub mod slope;
pub mod stroke;
pub mod text;
pub mod trig;
pub mod units;
