//! The memory: settings and poses in the EEPROM, and the bytes of RAM that survive a reset.
//!
//! [`record`] writes a block so that a power cut cannot damage the older one; [`copies`]
//! chooses between two blocks; [`settings`] is their content. [`kept`] and [`restart`] carry
//! the servos' state over a reset.

pub mod adjustment;
pub mod copies;
pub mod kept;
pub mod record;
pub mod restart;
pub mod settings;
