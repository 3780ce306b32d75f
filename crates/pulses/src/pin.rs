//! Arduino pins as port registers and bits.
//!
//! The numbers printed on the board differ from the chip's pin numbers, and the pins belong to three ports.

/// A pin D0 to D13 or A0 to A5 of an Arduino UNO or Nano.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pin {
    /// The data address of the pin's PORT register; DDR is at the address one below (data sheet, 14.4).
    pub(crate) port: u8,
    /// The bit mask of the pin in its PORT register.
    pub(crate) mask: u8,
}

impl Pin {
    /// Returns the pin with this number on the board: 0 to 13 for D0 to D13, 14 to 19 for A0 to A5; `None` for any
    /// other number. D0 and D1 belong to the serial port, D13 to the LED.
    #[must_use]
    pub const fn arduino(number: u8) -> Option<Self> {
        let (port, bit) = match number {
            0..=7 => (0x2b, number),
            8..=13 => (0x25, number - 8),
            14..=19 => (0x28, number - 14),
            _ => return None,
        };
        Some(Self {
            port,
            mask: 1 << bit,
        })
    }

    /// The data address of the pin's PORT register.
    #[must_use]
    pub const fn port(self) -> u8 {
        self.port
    }

    /// The bit mask of the pin in its PORT register.
    #[must_use]
    pub const fn mask(self) -> u8 {
        self.mask
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number, port and bit of the UNO's header pins D0 to D13 and A0 to A5, from the UNO's circuit diagram. The
    /// ports are named as in the data sheet.
    const HEADER_PINS: [(u8, char, u8); 20] = [
        (0, 'D', 0),
        (1, 'D', 1),
        (2, 'D', 2),
        (3, 'D', 3),
        (4, 'D', 4),
        (5, 'D', 5),
        (6, 'D', 6),
        (7, 'D', 7),
        (8, 'B', 0),
        (9, 'B', 1),
        (10, 'B', 2),
        (11, 'B', 3),
        (12, 'B', 4),
        (13, 'B', 5),
        (14, 'C', 0),
        (15, 'C', 1),
        (16, 'C', 2),
        (17, 'C', 3),
        (18, 'C', 4),
        (19, 'C', 5),
    ];

    #[test]
    fn every_pin_has_the_port_and_the_bit_of_the_circuit_diagram() {
        for (number, port, bit) in HEADER_PINS {
            let pin = Pin::arduino(number).expect("the UNO has this pin");
            // Data sheet, register summary: PORTB 0x25, PORTC 0x28, PORTD 0x2B.
            let address = match port {
                'B' => 0x25,
                'C' => 0x28,
                _ => 0x2b,
            };
            assert_eq!(pin.port(), address, "pin {number}");
            assert_eq!(pin.mask(), 1 << bit, "pin {number}");
        }
    }

    #[test]
    fn no_pin_has_a_number_above_19() {
        for number in 20..=255 {
            assert_eq!(Pin::arduino(number), None);
        }
    }
}
