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

    #[test]
    fn every_pin_has_the_port_and_the_bit_of_the_circuit_diagram() {
        // The UNO's circuit diagram: D0 to D7 are PD0 to PD7, D8 to D13 are PB0 to PB5, A0 to A5 are PC0 to PC5.
        // Data sheet, register summary: PORTB 0x25, PORTC 0x28, PORTD 0x2B.
        for (numbers, address) in [(0..=7, 0x2b), (8..=13, 0x25), (14..=19, 0x28)] {
            for (number, bit) in numbers.zip(0u8..) {
                let pin = Pin::arduino(number).expect("the UNO has this pin");
                assert_eq!(pin.port(), address, "pin {number}");
                assert_eq!(pin.mask(), 1 << bit, "pin {number}");
            }
        }
    }

    #[test]
    fn no_pin_has_a_number_above_19() {
        for number in 20..=255 {
            assert_eq!(Pin::arduino(number), None);
        }
    }
}
