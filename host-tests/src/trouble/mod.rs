//! Trouble at random moments: scenarios on the simulated UNO, judged by the safety rules.
//!
//! Tests of single features miss errors in the interaction of two features. So the main loop is stalled for 1 to 300
//! ms at random cycles during every activity of the robot; resets, power cuts and drops of the supply come, too. The
//! robot has a routine, and inputs whose contacts close and open. In four of thirteen scenarios a person also drives
//! the robot by radio. Only outputs that are visible from outside are judged: pulses, lines, the LED, writes to the
//! EEPROM. A scenario is determined by its seed and number, so a failing scenario can be played again.

mod activity;
pub mod campaign;
mod drive;
mod judge;
pub mod record;
pub mod scenario;
mod setup;
mod stage;
pub mod step;

pub use activity::Activity;
pub use campaign::{Failure, Summary, campaign, judge};
pub use judge::events;
pub use scenario::Scenario;
pub use stage::play;
