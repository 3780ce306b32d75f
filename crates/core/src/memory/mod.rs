//! The memory: settings and poses in the EEPROM, and the bytes of RAM that survive a reset.
//!
//! [`record`] writes a record in such an order that a power cut never leaves an incomplete record that looks valid.
//! [`copies`] stores the [`settings`] in two records, so that one of them is always valid; [`adjustment`] is the part
//! of the settings for one servo. [`retained_ram`] and [`restart`] preserve the state of the servos across a reset.

pub mod adjustment;
pub mod copies;
pub mod record;
pub mod restart;
pub mod retained_ram;
pub mod settings;
