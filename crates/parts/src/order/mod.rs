//! The order in which the robot is put together.
//!
//! A part that fits may still be one that no hand can put in: the screw is under the plate,
//! the key meets a servo. So each step is checked with the bodies that are there by then.

pub(crate) mod reach;
pub(crate) mod steps;
