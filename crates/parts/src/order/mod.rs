//! The order in which the robot is put together.
//!
//! A part that fits may still be impossible to put in: its screw is under the plate, or the
//! key hits a servo. So each step is checked with the bodies that are in place by then.

pub(crate) mod reach;
pub(crate) mod steps;
