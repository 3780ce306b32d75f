//! The mark of the firmware in flash, from which other programs read the section format that the firmware supports.
//!
//! A program that writes only a robot's section communicates with the boot loader while the firmware does not run. The
//! firmware must support the format of the section. Therefore the firmware has a mark at a fixed address, after the
//! interrupt vectors in the first page of flash. Any other program that is written to the board overwrites this page,
//! so no old mark remains.
//!
//! ```
//! use lizard_core::numbers::mark::{ADDRESS, Mark};
//!
//! let mut flash = vec![0xff; 128];
//! assert_eq!(Mark::read(&flash), None);
//! flash[ADDRESS..ADDRESS + 10].copy_from_slice(&Mark::THIS_FIRMWARE.bytes());
//! assert_eq!(Mark::read(&flash), Some(Mark::THIS_FIRMWARE));
//! ```

use crate::numbers::section::{FORMAT, MAGIC};

/// The address of the mark in flash, after the 26 vectors of an ATmega328P with 4 bytes each (data sheet, table 12-6).
pub const ADDRESS: usize = 26 * 4;

/// The length of the mark, bytes.
pub const LENGTH: usize = 10;

/// The mark of a firmware: its section format and its version.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark {
    /// The [`FORMAT`] of the sections that the firmware supports.
    pub format: u16,
    /// The firmware's version: major, minor, patch.
    pub version: [u8; 3],
}

impl Mark {
    /// The mark of this firmware.
    pub const THIS_FIRMWARE: Self = Self {
        format: FORMAT,
        version: [
            parse_number(env!("CARGO_PKG_VERSION_MAJOR")),
            parse_number(env!("CARGO_PKG_VERSION_MINOR")),
            parse_number(env!("CARGO_PKG_VERSION_PATCH")),
        ],
    };

    /// Returns the bytes in flash: magic, format, version, and a zero, because code must begin at an even address.
    pub const fn bytes(self) -> [u8; LENGTH] {
        let [a, b, c, d] = MAGIC.to_le_bytes();
        let [low, high] = self.format.to_le_bytes();
        let [major, minor, patch] = self.version;
        [a, b, c, d, low, high, major, minor, patch, 0]
    }

    /// Reads the mark from `flash`, whose bytes begin at address 0; returns `None` if there is no mark.
    pub fn read(flash: &[u8]) -> Option<Self> {
        let bytes = flash.get(ADDRESS..ADDRESS + LENGTH)?;
        let (magic, fields) = bytes.split_first_chunk()?;
        let &[low, high, major, minor, patch, 0] = fields else {
            return None;
        };
        (u32::from_le_bytes(*magic) == MAGIC).then_some(Self {
            format: u16::from_le_bytes([low, high]),
            version: [major, minor, patch],
        })
    }
}

/// Parses a number of the version.
const fn parse_number(text: &str) -> u8 {
    match u8::from_str_radix(text, 10) {
        Ok(number) => number,
        Err(_) => panic!("each number of the version must be at most 255"),
    }
}

#[cfg(test)]
mod tests {
    use std::format;

    use super::*;

    #[test]
    fn the_version_matches_the_package() {
        let [major, minor, patch] = Mark::THIS_FIRMWARE.version;
        let version = format!("{major}.{minor}.{patch}");
        assert_eq!(version, env!("CARGO_PKG_VERSION"));
    }

    #[test]
    fn a_flipped_bit_results_in_another_mark_or_none() {
        let mut flash = [0xff; 128];
        flash[ADDRESS..ADDRESS + LENGTH].copy_from_slice(&Mark::THIS_FIRMWARE.bytes());
        for address in ADDRESS..ADDRESS + LENGTH {
            for bit in 0..8 {
                let mut flash = flash;
                flash[address] ^= 1 << bit;
                let mark = Mark::read(&flash);
                assert_ne!(mark, Some(Mark::THIS_FIRMWARE), "bit {bit} at {address}");
            }
        }
        assert_eq!(Mark::read(&flash[..ADDRESS + LENGTH - 1]), None);
    }
}
