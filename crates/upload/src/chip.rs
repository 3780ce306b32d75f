//! The chips of boards, identified by their signatures. An image for one type of chip may fail on another.

use std::fmt;

/// A chip's signature, as the boot loader reports it (data sheets, "Signature Bytes").
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Chip(pub [u8; 3]);

impl Chip {
    /// The ATmega328P of an Arduino UNO.
    pub const ATMEGA328P: Self = Self([0x1e, 0x95, 0x0f]);

    /// The type's name with its article; `None` if the signature is unknown.
    fn name_with_article(self) -> Option<&'static str> {
        Some(match self.0 {
            [0x1e, 0x95, 0x0f] => "an ATmega328P",
            [0x1e, 0x95, 0x14] => "an ATmega328 without P",
            [0x1e, 0x95, 0x16] => "an ATmega328PB",
            [0x1e, 0x94, 0x06] => "an ATmega168",
            [0x1e, 0x94, 0x0b] => "an ATmega168P",
            [0x1e, 0x93, 0x07] => "an ATmega8",
            [0x1e, 0x97, 0x03] => "an ATmega1280",
            _ => return None,
        })
    }
}

impl fmt::Display for Chip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b, c] = self.0;
        let description = self.name_with_article().unwrap_or("of an unknown type");
        write!(f, "{description} (signature {a:02X} {b:02X} {c:02X})")
    }
}
