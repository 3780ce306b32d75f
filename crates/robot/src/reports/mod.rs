//! Tables about a robot's gaits for people, and messages about poses that are not allowed.
//!
//! The author of a gait needs to know three things: the gait's distance from the limits, the displacement of the robot,
//! and the effect of another floor, other feet or softer legs on this displacement. A table answers each question.

mod assumptions;
mod drive_effect;
mod report;
mod routine_row;
mod sensitivity;
mod servo_table;
pub mod violations;

pub use assumptions::{Assumptions, Extreme, MovementRange, plausible_range};
pub use drive_effect::DriveEffect;
pub use report::{GaitRow, OPEN_INPUTS_NOTE, Report, UNDETERMINED_NOTE};
pub use routine_row::RoutineRow;
pub use sensitivity::Sensitivity;
pub use servo_table::{PACES_PERCENT, ServoTable};
