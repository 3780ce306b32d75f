//! The core of a robotic lizard's firmware, for any such robot and any board.
//!
//! Four hobby servos drive two five-bar linkages and four legs, whose feet drag on the floor. A line of text requests a
//! gait or a pose. Fifty times a second the core converts the request to four pulse widths, which the servos can follow
//! and which cannot break a linkage.
//!
//! Commands pass from the console to the pulses through the types in the first row; answers return through the types in
//! the second row:
//!
//! ```text
//!         Console                     Controller                             Board
//! bytes -> Line -> Command -> Order -> Motion (Gait, PointToPointMove) -> guard -> Pulses -> timer
//! lines <- print <- AnswerPart <- Refusal <- Safety (supervisor's table) <- Health
//! ```
//!
//! [`step::Main`], the main loop of a board, connects a [`console::Console`] with a [`control::Controller`]. Below it
//! are six modules, each of which uses only the modules below it in this table:
//!
//! | module | contents |
//! |---|---|
//! | [`console`] | bytes, lines, commands, messages |
//! | [`control`] | orders, refusals, the tables of the [`control::supervisor`], faults, supplies |
//! | [`motion`] | gaits, moves between poses, and the transitions between them |
//! | [`guard`] | the geometry: margins to the singularities, strokes, the limit that a pose violates |
//! | [`memory`] | settings and poses that survive power-off, and a state that survives a reset |
//! | [`numbers`] | units, and the section of flash with the numbers of a robot |
//!
//! This example shows two parts that require no robot: bytes form a line, and an angle is converted to a servo's pulse.
//! `virtual_board` (feature `host`) runs a whole robot on a simulated board.
//!
//! ```
//! use lizard_core::numbers::calibration::Calibration;
//! use lizard_core::console::line::{Line, LineKind};
//! use lizard_core::numbers::units::{Angle, CYCLES_PER_US, PulseWidth, Sweep};
//!
//! let mut line = Line::new();
//! let line_kind = b"Pose 120\r".iter().find_map(|byte| line.push(*byte));
//! assert_eq!((line_kind, line.text()), (Some(LineKind::Valid), &b"pose 120"[..]));
//!
//! // A servo that is at 90 degrees with a pulse of 1500 us and turns 90 degrees either way, at 10 us per degree:
//! // 57 600 cycles for a turn of 65 536 steps, or 0.879 cycles per step. A gain of 1 << 14 is one cycle per step.
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
//! 1. **Safe.** Every frame passes the guard, no two servos wake at the same time, and after a fault the robot stands
//!    still and reports the reason.
//! 2. **Exact.** A pulse is correct to the cycle, and a frame on the host equals the chip's frame bit for bit.
//! 3. **Plain.** Each concept is a type, each choice is an enum, and each refusal has a message.
//! 4. **Small.** Flash and RAM have the lowest priority: a type that costs a few bytes is kept while the program fits.
//!
//! All arithmetic of the firmware uses integers and runs unchanged on the host, where the tests compare it with
//! floating point. A robot's numbers come from its section of flash ([`numbers::section`], [`numbers::robot::Robot`]);
//! the trait [`step::Board`] gives access to the board. This crate accesses neither registers nor files.
//!
//! Do not use this crate for a robot with other mechanics: head, tail and sides must be five-bars on exactly four
//! servos. To generate only pulses, use `servo-pulses`; to explore a linkage on a host, use the floating-point crate
//! `lizard-kinematics`.

#![no_std]
#![allow(clippy::new_without_default, reason = "a constant `new` is enough")]

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
