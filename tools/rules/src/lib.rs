//! The safety rules: promises to the user, each in one sentence, and an observer that checks a robot against them.
//!
//! Three tools test these rules: the model checker (`tools/explore`), the search with combined faults on the simulated
//! UNO (`make trouble`) and the fuzzer (`tools/fuzz`). Each tool converts its robot's behaviour to a sequence of
//! [`Event`]s with times, and the [`Observer`] checks these events. The observer sees no internal state of the robot,
//! only lines of text, pulses, resets, the supply and writes to the EEPROM.
//!
//! A few rules of [`Rule`] concern the internal state; only tools that see it check them.

mod answers;
mod coarse_state;
mod event;
pub mod led;
mod limits;
mod observer;
mod pulses;
mod reports;
mod rule;
mod supply;

pub use coarse_state::CoarseState;
pub use event::{Event, MS, Pulse, Time};
pub use limits::Limits;
pub use observer::Observer;
pub use rule::{Rule, Violation};
