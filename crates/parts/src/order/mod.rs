//! The order of assembly.
//!
//! A part that fits may still be impossible to mount: its screw is under the plate, or the key hits a servo. Each step
//! is therefore checked against the bodies that are already in place.

pub(crate) mod reach;
pub(crate) mod steps;
