//! Trouble at random moments: scenarios on the simulated UNO, and what must hold in all
//! of them.
//!
//! Where two features meet, tests of each alone see nothing. So main stalls for 1 to
//! 300 ms at random cycles of everything that the robot does; resets, power cuts and dips
//! of the supply come between. What is judged is seen from outside: pulses, lines, the
//! LED, what is written to the EEPROM. A scenario is made of its seed and number alone,
//! so one that fails can be played again.

mod activity;
pub mod campaign;
pub mod invariants;
pub mod record;
pub mod scenario;
mod setup;
mod stage;
pub mod step;

pub use activity::Activity;
pub use campaign::{Failure, Summary, campaign, judge};
pub use scenario::Scenario;
pub use stage::play;
