//! The safety rules: a list of sentences on which a user may rely, and an observer that judges a robot by these rules.
//!
//! Three tools test these rules: the model checker (`tools/explore`), the search with combined faults on the simulated
//! UNO (`make trouble`) and the fuzzer (`tools/fuzz`). Each tool converts the behaviour of its robot to a sequence of
//! [`Event`]s with times, and the [`Observer`] judges these events. The observer does not know the robot's inner state,
//! only lines, pulses, resets, the supply and writes to the EEPROM.
//!
//! [`Rule`] also lists rules about the inner state. Only the tools that see the inner state check these.

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
pub use rule::{BrokenRule, Rule};
