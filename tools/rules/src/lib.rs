//! The rules of safety: a list of sentences that a user may rely on, and an observer who judges a
//! robot by them.
//!
//! The model checker (`tools/explore`), the search for trouble on the simulated UNO
//! (`make trouble`) and the search for harmful bytes (`tools/fuzz`) test the same promises.
//! Each turns what its robot does into a sequence of [`Event`]s with their times, and the
//! [`Observer`] judges them. It knows nothing of the robot's inner state: only lines,
//! pulses, resets, the supply and what is written to the EEPROM.
//!
//! A rule that needs more than that is in the same list, [`Rule`], and is checked by the tools
//! that see the inner state.

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
