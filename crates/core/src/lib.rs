//! The core of a robotic lizard's firmware, for any such robot and any board.
//!
//! Four hobby servos drive two five-bar linkages and four legs, whose feet drag on the floor. A line of text requests
//! a gait or a pose; fifty times a second the core turns the request into four pulse widths that the servos
//! can follow and that cannot break a linkage of the robot.
//!
//! Commands pass from the console to the pulses through the types of the first row, and answers return through those
//! of the second row:
//!
//! ```text
//!         Console                     Controller                             Board
//! bytes -> Line -> Command -> Order -> Motion (Gait, PointToPointMove) -> guard -> Pulses -> timer
//! lines <- print <- Answer <- Refusal <- Safety (supervisor's table) <- Health
//! ```
//!
//! [`step::Main`] joins a [`console::Console`] and a [`control::Controller`]: it is the loop
//! that a board repeats. Below it are six modules, each of which uses only those below
//! it in this table:
//!
//! | module | contents |
//! |---|---|
//! | [`console`] | bytes, lines, commands, messages |
//! | [`control`] | orders, refusals, the [`control::supervisor`]'s table, faults, supplies |
//! | [`motion`] | gaits, moves between poses, and the changes from one to the next |
//! | [`guard`] | the geometry: margins to the singularities, strokes, the limit that a pose violates |
//! | [`memory`] | settings and poses that survive power-off, and a state that survives a reset |
//! | [`numbers`] | units, and the section of flash with the numbers of a robot |
//!
//! This example shows two parts that need no robot: bytes become a line, and an angle
//! becomes the pulse that turns a servo to it. A whole robot on a simulated board is in
//! `virtual_board` (feature `host`).
//!
//! ```
//! use lizard_core::numbers::calibration::Calibration;
//! use lizard_core::console::line::{LineEnd, Line};
//! use lizard_core::numbers::units::{Angle, CYCLES_PER_US, PulseWidth, Sweep};
//!
//! let mut line = Line::new();
//! let line_end = b"Pose 120\r".iter().find_map(|byte| line.push(*byte));
//! assert_eq!((line_end, line.text()), (Some(LineEnd::Line), &b"pose 120"[..]));
//!
//! // A servo that holds 90 degrees at 1500 us and turns 90 degrees either way, 10 us for
//! // each degree: that makes 57 600 cycles for a turn of 65 536 steps, or 0.879 cycles for a step.
//! let servo = Calibration {
//!     neutral_width: PulseWidth(1500 * CYCLES_PER_US),
//!     gain: (57_600 << 14 >> 16) as i16,
//!     travel_min: Sweep(-0x4000),
//!     travel_max: Sweep(0x3fff),
//! };
//! let sweep = Angle::from_centideg(9_000).sweep_to(Angle::from_centideg(12_000));
//! assert!(servo.reaches(sweep));
//! assert_eq!(servo.width(sweep), PulseWidth(1800 * CYCLES_PER_US), "300 us longer");
//! ```
//!
//! The goals, in order of priority:
//!
//! 1. **Safe.** No frame is sent without the guard, no two servos wake together, and after
//!    a fault the robot stands still and reports the reason.
//! 2. **Exact.** A pulse is correct to the cycle, and a frame on the host equals the chip's
//!    to the bit.
//! 3. **Plain.** Each concept is a type, each choice is an enum, and each refusal has a message.
//! 4. **Small.** Flash and RAM come last: a type that costs a few bytes is kept as long as
//!    the program fits.
//!
//! Everything here is integer arithmetic and runs unchanged on the microcontroller and on
//! the host, where the tests compare it with floating point. The numbers of a robot come
//! from its section of flash ([`numbers::section`], [`numbers::robot::Robot`]), the board
//! through the trait [`step::Board`]; this crate can name neither a register nor a file.
//!
//! Do not use this crate for a robot of another build: head, tail and sides have to be five-bars on
//! exactly four servos. To send pulses alone, use `servo-pulses`; to explore a linkage on
//! a host, use the floating-point crate `lizard-kinematics`.

#![no_std]

#[cfg(any(test, feature = "host"))]
extern crate std;

pub mod console;
pub mod control;
pub mod guard;
pub mod memory;
pub mod motion;
pub mod numbers;
#[cfg(test)]
mod sample;
pub mod step;
#[cfg(any(test, feature = "host"))]
pub mod virtual_board;
