//! The core of a robotic lizard's firmware, for any such robot and any board.
//!
//! Four hobby servos drive two five-bar linkages; four dragging feet follow them. A line
//! of text asks for a gait or a pose; fifty times a second the core turns the request
//! into four pulse widths that the servos can follow and that cannot break a linkage of
//! the robot.
//!
//! Values move one way. A console gives orders to the robot, the robot computes a frame
//! fifty times a second, and its answers go back the same way:
//!
//! ```text
//!         Console                     Control                                Board
//! bytes -> Line -> Command -> Order -> Motion (Gait, PointToPoint) -> guard -> Pulses -> timer
//! lines <- print <- Answer <- Refusal <- Safety (supervisor's table) <- Health
//! ```
//!
//! [`step::Main`] holds a [`console::Console`] and a [`control::Control`] and does one
//! thing at a time. The console knows bytes and lines and gives orders; the control knows
//! none of that, owns motion, settings and safety, and says why it refuses. One table,
//! [`supervisor`], says what it does at each event in each state.
//!
//! This example shows two pieces that need no robot: bytes become a line, and an angle
//! becomes the pulse that turns a servo there. All of it, on a board without a chip, is
//! in `virtual_board` (feature `host`).
//!
//! ```
//! use lizard_core::calibration::Calibration;
//! use lizard_core::line::{Ended, Line};
//! use lizard_core::units::{Angle, CYCLES_PER_US, Sweep, Width};
//!
//! let mut line = Line::new();
//! let ended = b"Pose 120\r".iter().find_map(|byte| line.push(*byte));
//! assert_eq!((ended, line.text()), (Some(Ended::Line), &b"pose 120"[..]));
//!
//! // A servo that holds 90 degrees at 1500 us and turns 90 degrees either way, 10 us for
//! // each degree: 57 600 cycles for a turn of 65 536 steps, and so 0.879 for a step.
//! let servo = Calibration {
//!     neutral: Width(1500 * CYCLES_PER_US),
//!     gain: (57_600 << 14 >> 16) as i16,
//!     min: Sweep(-0x4000),
//!     max: Sweep(0x3fff),
//! };
//! let sweep = Angle::from_centideg(9_000).sweep_to(Angle::from_centideg(12_000));
//! assert!(servo.reaches(sweep));
//! assert_eq!(servo.width(sweep), Width(1800 * CYCLES_PER_US), "300 us longer");
//! ```
//!
//! The goals, in this order, if two of them conflict:
//!
//! 1. **Safe.** No frame is sent without the guard, no two servos wake together, and a
//!    fault ends in a robot that stands still and says why.
//! 2. **Exact.** A pulse is right to the cycle, and a frame on the host equals the chip's
//!    to the bit.
//! 3. **Plain.** A type for a thing, an enum for a choice, a sentence for a refusal.
//! 4. **Small.** Flash and RAM come last: a type that costs a few bytes stays, as long as
//!    the program fits.
//!
//! Everything here is integer arithmetic and runs unchanged on the
//! microcontroller and on the host, where the tests compare it with floating
//! point. The numbers of a robot come from its section of flash ([`section`],
//! [`robot::Robot`]), the board through the trait [`step::Board`]; this crate can name neither a
//! register nor a file.

#![no_std]

#[cfg(any(test, feature = "host"))]
extern crate std;

pub mod adjustment;
pub mod answer;
#[cfg(any(test, feature = "host"))]
pub mod bounds;
pub mod calibration;
pub mod cells;
mod check;
mod checksum;
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
pub mod mark;
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
pub mod section;
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
