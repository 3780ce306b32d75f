//! Human-readable tables of a robot's gaits, and messages about poses that are not allowed.
//!
//! The author of a gait asks three questions: how close does the gait come to the limits, how far does it move the
//! robot, and how does this displacement change on another floor, or with other feet, legs or servos? The table of
//! gaits in `report.rs` answers the first two questions, the other tables answer the third.

mod assumptions;
mod drive_effect;
mod report;
mod routine_row;
mod sensitivity;
mod servo_table;
pub mod violations;

pub use assumptions::{Assumptions, DisplacementRange, Extreme, plausible_range};
pub use drive_effect::DriveEffect;
pub use report::{GaitRow, OPEN_INPUTS_NOTE, Report, UNDETERMINED_NOTE};
pub use routine_row::RoutineRow;
pub use sensitivity::Sensitivity;
pub use servo_table::{PACES_PERCENT, ServoTable};
