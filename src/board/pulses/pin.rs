//! Which register and bit a pin of the Arduino is.
//!
//! The numbers printed on the board say nothing about the chip: its pins sit in
//! three ports in an order of their own. This file uses nothing but the language,
//! so that a test on the host can compare every number with a pin diagram.

/// A pin of the UNO that a servo may be plugged into.
#[derive(Clone, Copy)]
pub struct Pin {
    /// Data address of its PORT register; DDR is one below (data sheet, 13.4 and 30).
    pub port: u8,
    /// Its bit in that register.
    pub mask: u8,
}

impl Pin {
    /// The pin that is printed on the board as D2 to D12, or as A0 to A5 for 14
    /// to 19. D0 and D1 are the serial line, D13 is the LED.
    ///
    /// # Panics
    /// For any other number; while the firmware is compiled, for that is when the
    /// pins are worked out.
    pub const fn arduino(number: u8) -> Self {
        let (port, bit) = match number {
            2..=7 => (0x2b, number),
            8..=12 => (0x25, number - 8),
            14..=19 => (0x28, number - 14),
            _ => panic!("a servo goes to one of D2 to D12 or A0 to A5"),
        };
        Self {
            port,
            mask: 1 << bit,
        }
    }
}
