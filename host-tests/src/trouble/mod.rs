//! Fault injection at random moments: scenarios on the simulated UNO, checked against the safety rules.
//!
//! Tests of single features miss errors in the interaction of two features. These scenarios therefore inject faults at
//! random cycles during every activity of the robot: stalls of the main loop of 1 to 300 ms, resets, power cuts and
//! dips of the supply voltage. The robot has a routine, and inputs whose contacts close and open. In four of thirteen
//! scenarios a person also drives the robot by radio. The rule checks see only outputs that are visible from outside:
//! pulses, lines, the LED, writes to the EEPROM. Seed and number determine a scenario, so a failing scenario can be
//! repeated.

mod activity;
mod campaign;
mod drive;
mod random_commands;
pub mod record;
mod rule_checks;
pub mod scenario;
mod scenario_run;
pub mod step;

pub use activity::Activity;
pub use campaign::{Failure, Summary, run_and_check, run_campaign};
pub use rule_checks::collect_events;
pub use scenario::Scenario;
pub use scenario_run::run_scenario;
