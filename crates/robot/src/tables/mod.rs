//! The robot as the firmware reads it: integers, tables and maps in a section of flash.
//!
//! The chip has 32 KB of flash, 20 ms for a frame, and no floating point. All values that it reads are therefore
//! computed here once: the robot's numbers in the core's types, the gaits as waveforms of 64 samples, and the cells in
//! which every pose is proven to be safe.

mod cells;
mod core_robot;
pub(crate) mod numbers;
mod table;

pub use cells::CellMaps;
pub use core_robot::{CoreRobot, flash};
pub(crate) use table::Tables;
