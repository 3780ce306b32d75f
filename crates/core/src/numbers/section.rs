//! The robot's section of flash: all data of robot.toml that the firmware uses.
//!
//! One firmware image serves any robot. The numbers that differ between robots are at a fixed address after the image,
//! and can be written without a compiler. This part of flash may contain anything: erased bytes, an incomplete upload,
//! a section of another version, a byte that has changed over the years. Therefore nothing in the section is used
//! before [`crate::numbers::robot::Robot::open`] has checked its header, length and CRC, and every index and count is
//! checked where it is used.
//!
//! | part | bytes | contents |
//! |---|---|---|
//! | [`Header`] | 36 | magic, [`FORMAT`], length, checksum of the following bytes, name, hash of the numbers, hash of the servos |
//! | [`Numbers`] | 232 | link lengths, servos, limits, supplies, pins, and the addresses of the parts below |
//! | curves | 354 each | tables of the couplers of head and tail, equal tables only once: the rise and, if [`Numbers::curves`] has their addresses, the stretched rise, the folded rise and the skew |
//! | gaits | 32 each | [`crate::numbers::gaits::Gait`]; the routines follow the gaits |
//! | steps | 4 each | the steps of the routines, [`crate::numbers::gaits::Step`] |
//! | waveforms | 128 each | 64 samples, [`crate::numbers::gaits::Wave`] |
//! | names | | the names of gaits and routines, one after another |
//! | maps | 2 per row | the certified cells of head, tail, left and right: first and last column of each row |
//!
//! Each part is stored as the type in the table, field by field, low bytes first. The factors derived from the link
//! lengths are stored, too, so the firmware need not compute them.

use core::mem::offset_of;

pub use lizard_avr::Region;

use crate::numbers::calibration::{Calibration, SweepRange};
use crate::numbers::checksum::Checksum;
use crate::numbers::limits::Limits;
use crate::numbers::link_lengths::LinkLengths;
use crate::numbers::slew::Slew;
use crate::numbers::slider::Slider;
use crate::numbers::supplies::Supplies;
use crate::numbers::units::Angle;

#[cfg(any(test, feature = "host"))]
pub use content::{Content, FiveBarLengths, Map};
#[cfg(any(test, feature = "host"))]
pub use seal::write_checksum;

#[cfg(any(test, feature = "host"))]
mod content;
#[cfg(any(test, feature = "host"))]
mod seal;

/// The format of a section, incremented when the meaning of a byte changes.
pub const FORMAT: u16 = 3;

/// The first four bytes of a section.
pub const MAGIC: u32 = u32::from_le_bytes(*b"LZRD");

/// The address of the section in flash, `START_ADDRESS`, and the largest size of a section, `REGION_BYTES`.
pub use lizard_avr::{REGION_BYTES, START_ADDRESS};

/// The largest length of a robot's name, bytes.
pub const MAX_NAME_BYTES: usize = 18;

lizard_avr::pod! {
    /// The header, the first part of a section.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Header {
        /// Always [`MAGIC`].
        pub magic: u32,
        /// The section's format, [`FORMAT`].
        pub format: u16,
        /// The length of the section including this header, bytes.
        pub length: u16,
        /// The [`Checksum`] of all bytes of the section after this field.
        pub crc: u16,
        /// The robot's name, padded with zeros.
        pub name: [u8; MAX_NAME_BYTES],
        /// The hash that identifies the robot, which is the CRC-32 of all parts except the header and the maps.
        pub hash: u32,
        /// The hash of the servos alone: their pins, neutral angles, pulses and travel. Settings are saved with it, and
        /// are valid only for servos with the same hash.
        pub servo_hash: u32,
    }
}

lizard_avr::pod! {
    /// The numbers of a robot.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Numbers {
        /// The link lengths of head and tail, each in its own frame.
        pub ends: [LinkLengths; 2],
        /// The left and the right slider.
        pub sliders: [Slider; 2],
        /// The servos' angles in the neutral pose.
        pub neutral_angles: [Angle; 4],
        /// The calibration of the servos.
        pub calibration: [Calibration; 4],
        /// The range of sweeps that the gaits need from each servo.
        pub needed_travel: [SweepRange; 4],
        /// The smallest allowed margins.
        pub limits: Limits,
        /// The slew limit of a move.
        pub slew: Slew,
        /// The supplies and their thresholds.
        pub supplies: Supplies,
        /// The addresses of the couplers' tables for head and tail: rise, stretched rise, folded rise, skew; 0 for a
        /// missing table.
        pub curves: [[u16; CURVE_COUNT]; 2],
        /// The parts, in the order of [`SectionPart`].
        pub parts: [PartRange; PART_COUNT],
        /// The Arduino number of the pin where the servo rail is measured; 0 if the rail is not measured.
        pub rail_pin: u8,
        /// The pace to which a low supply limits gaits, in percent of the pace in robot.toml, 10 to 100.
        pub slow_pace: u8,
        /// The Arduino numbers of the servo pins; 14 to 19 are A0 to A5.
        pub pins: [u8; 4],
        /// The headers of the maps of head, tail, left and right. The hash does not include them.
        pub maps: [MapHeader; 4],
    }
}

/// The offset of the numbers from the section's beginning, bytes.
pub(crate) const NUMBERS_OFFSET: u16 = size_of::<Header>() as u16;
/// The offset of the first byte after the numbers from the section's beginning, bytes.
pub(crate) const AFTER_NUMBERS_OFFSET: u16 = NUMBERS_OFFSET + size_of::<Numbers>() as u16;

/// The number of curves for each pair of couplers.
pub const CURVE_COUNT: usize = 4;

/// A part of the section whose address and number of elements are in [`Numbers::parts`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectionPart {
    /// The gaits and the routines, each a [`crate::numbers::gaits::Gait`].
    Gaits,
    /// The waveforms, each a [`crate::numbers::gaits::Wave`].
    Waves,
    /// The bytes of the names of gaits and routines.
    Names,
    /// The rows of the maps of certified cells.
    Rows,
}

/// The number of parts in [`SectionPart`].
pub const PART_COUNT: usize = 4;

lizard_avr::pod! {
    /// The address and the number of elements of a part of the section.
    #[derive(Debug, PartialEq, Eq)]
    pub struct PartRange {
        /// The address of the part from the section's beginning, bytes.
        pub address: u16,
        /// The number of elements.
        pub count: u16,
    }
}

lizard_avr::pod! {
    /// The header of a map of certified cells.
    #[derive(Debug, PartialEq, Eq)]
    pub struct MapHeader {
        /// The row number of the first row, see [`crate::numbers::cells::CellMap::from_rows`].
        pub first_row: i8,
        /// The number of rows.
        pub row_count: u8,
    }
}

/// The error in a section that is not a valid robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Discriminants start at 1, so that `Option::None` is all zeros: see `Main::new`.
#[repr(u8)]
pub enum SectionError {
    /// There is no section, because the magic bytes are missing.
    Missing = 1,
    /// The section has the format of another version of the firmware.
    OtherFormat,
    /// The section is incomplete or has changed since it was written.
    Damaged,
    /// The section is intact, but a number in it could damage hardware.
    Harmful,
}

/// The offset of the first byte that the checksum covers.
const CHECKED_START: usize = offset_of!(Header, name);

/// Checks the section at the beginning of a region, and returns the section's length.
///
/// # Errors
/// Returns [`SectionError::Missing`], [`SectionError::OtherFormat`] or [`SectionError::Damaged`].
#[inline(never)]
pub fn check(flash: Region) -> Result<u16, SectionError> {
    if flash.size() < NUMBERS_OFFSET {
        return Err(SectionError::Missing);
    }
    if flash.read::<u32>(offset_of!(Header, magic) as u16) != MAGIC {
        return Err(SectionError::Missing);
    }
    if flash.read::<u16>(offset_of!(Header, format) as u16) != FORMAT {
        return Err(SectionError::OtherFormat);
    }
    let length = flash.read(offset_of!(Header, length) as u16);
    if length < AFTER_NUMBERS_OFFSET || length > flash.size() {
        return Err(SectionError::Damaged);
    }
    let mut checksum = Checksum::EMPTY;
    let mut offset = CHECKED_START as u16;
    while offset < length {
        checksum = checksum.with_byte(flash.read(offset));
        offset += 1;
    }
    if checksum.0 != flash.read(offset_of!(Header, crc) as u16) {
        return Err(SectionError::Damaged);
    }
    Ok(length)
}
