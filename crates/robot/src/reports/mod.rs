//! Tables of a robot's gaits for people, and the reasons why a pose is refused.
//!
//! The author of a gait needs three things: its distance from the limits, its movement, and the effect of another
//! floor, other feet or softer legs. Each is a table.

mod assumptions;
mod report;
mod round;
mod sensitivity;
mod servos;
mod spring_cost;
pub mod verdict;

pub use assumptions::{Assumptions, Extreme, MovementRange, plausible_range};
pub use report::{Report, Row, UNDECIDED, WITHOUT_CONTACTS};
pub use round::Round;
pub use sensitivity::Sensitivity;
pub use servos::{PACES, ServoTable};
pub use spring_cost::SpringCost;
