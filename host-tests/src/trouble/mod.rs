//! Fault injection at random moments: scenarios on the simulated UNO, judged by the safety rules.
//!
//! Tests of single features miss errors in the interaction of two features. In these scenarios the main loop is stalled
//! for 1 to 300 ms at random cycles during every activity of the robot, and there are resets, power cuts and dips of
//! the supply voltage: together, the trouble of a scenario. The robot has a routine, and inputs whose contacts close
//! and open. In four of thirteen scenarios a person also drives the robot by radio. The judge sees only the outputs
//! that are visible from outside: pulses, lines, the LED, writes to the EEPROM. Seed and number determine a scenario,
//! so a failing scenario can be replayed.

mod activity;
mod campaign;
mod drive;
mod judge;
pub mod record;
pub mod scenario;
mod setup;
mod stage;
pub mod step;

pub use activity::Activity;
pub use campaign::{Failure, Summary, judge, run_campaign};
pub use judge::events;
pub use scenario::Scenario;
pub use stage::play;
