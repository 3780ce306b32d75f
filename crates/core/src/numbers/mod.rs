//! The numbers of a robot: units, integer arithmetic, types without behaviour, and the section of flash that contains
//! the numbers.
//!
//! This is the lowest module of the crate: every other module uses it, but it uses no other module.

pub mod calibration;
pub mod cells;
pub(crate) mod checksum;
pub mod couplers;
pub mod curve;
pub mod gaits;
pub mod integer_math;
pub mod limits;
pub mod link_lengths;
pub mod mark;
pub mod part;
pub mod pose;
pub mod rate;
pub mod robot;
pub mod section;
pub mod slew;
pub mod slider;
pub mod supplies;
pub mod units;
