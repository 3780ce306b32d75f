//! The memory: settings and poses in the EEPROM, and the bytes of RAM that survive a reset.
//!
//! [`record`] writes a record so that a power cut leaves no half-written record that looks valid; [`copies`] keeps two
//! records of [`settings`], so that one of them is always valid; [`adjustment`] is the part of the settings that
//! belongs to one servo. [`retained_ram`] and [`restart`] carry the servos' state across a reset.

pub mod adjustment;
pub mod copies;
pub mod record;
pub mod restart;
pub mod retained_ram;
pub mod settings;
