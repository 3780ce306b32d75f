//! The numbers of a robot: their units, types and integer arithmetic, and the section of flash that contains them; also
//! the firmware's mark and the baud rates.
//!
//! This is the lowest layer of the crate: every other layer uses it, and it uses none of them.

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
