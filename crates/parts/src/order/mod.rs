//! The order of assembly.
//!
//! A part that fits may still be impossible to put in: its screw is under the plate, or the key hits a servo. So
//! each step is checked against the bodies that are already in place.

pub(crate) mod reach;
pub(crate) mod steps;
