//! The console: lines in, answers out.
//!
//! The highest of the core's six folders. It knows bytes, lines and messages, gives
//! [orders](crate::control::order) to the robot and prints the answers. A board without a serial line does not
//! need this module.

pub mod answer;
pub mod command;
mod dialogue;
pub mod digits;
mod finder;
pub mod line;
pub mod output;
mod print;
mod refusal;
pub mod text;
mod watch;
pub mod word;

pub use dialogue::{Console, LONGEST_LINE};
