//! The rules of safety: a list of sentences that a user may rely on, and an observer that judges a
//! robot by these rules.
//!
//! The model checker (`tools/explore`), the search for trouble on the simulated UNO
//! (`make trouble`) and the search for harmful bytes (`tools/fuzz`) all test these rules.
//! Each tool turns what its robot does into a sequence of [`Event`]s with their times, and the
//! [`Observer`] judges the events. It knows nothing of the robot's inner state: only lines,
//! pulses, resets, the supply and what is written to the EEPROM.
//!
//! A rule about the inner state is also in the list, [`Rule`], but only the tools that see the
//! inner state check it.

mod answers;
mod event;
pub mod led;
mod observer;
mod print;
mod reports;
mod rule;
mod servos;
mod supply;

pub use event::{Event, MS, Pulse, Time};
pub use observer::{Limits, Observer};
pub use print::frames_class;
pub use rule::{BrokenRule, Rule};
