//! The robot in the form that the firmware reads from flash: integers, gait tables and maps of safe poses.
//!
//! The chip has 32 KB of flash, 20 ms for a frame, and no floating point. Therefore everything that it reads is
//! computed here, in advance: the robot's numbers in the core's types, the gaits as waveforms of 64 samples, and the
//! maps of cells (regions of the pose space) in which every pose is proven to be safe.

mod cells;
mod core_robot;
pub(crate) mod numbers;
mod table;

pub use cells::CellMaps;
pub use core_robot::{CoreRobot, keep_section};
pub(crate) use table::Tables;
