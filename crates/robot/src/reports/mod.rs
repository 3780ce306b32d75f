//! Tables about a robot's gaits for people, and the reasons why a pose is refused.
//!
//! The author of a gait needs to know three things: how far the gait is from the limits, how it moves the robot, and
//! how another floor, other feet or softer legs change this movement. A table answers each question.

mod assumptions;
mod report;
mod round;
mod sensitivity;
mod servos;
mod spring_cost;
pub mod verdict;

pub use assumptions::{Assumptions, Extreme, MovementRange, plausible_range};
pub use report::{Report, Row, UNDECIDED_NOTE, WITHOUT_CONTACTS_NOTE};
pub use round::Round;
pub use sensitivity::Sensitivity;
pub use servos::{PACES_PERCENT, ServoTable};
pub use spring_cost::SpringCost;
