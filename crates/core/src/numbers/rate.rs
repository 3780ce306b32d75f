//! The baud rates of the serial port.

/// A baud rate of the serial port. The variants are numbered from the fastest to the slowest; the number is stored in
/// RAM that survives a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum BaudRate {
    /// 115 200 baud, the rate on the USB port.
    Fastest,
    /// 57 600 baud, half of the fastest rate.
    Half,
    /// 38 400 baud, a third of the fastest rate.
    Third,
    /// 9600 baud, the factory setting of most radio modules.
    Slowest,
}

impl BaudRate {
    /// All rates, in the order in which autobaud tries them.
    pub const ALL: [Self; 4] = [Self::Fastest, Self::Half, Self::Third, Self::Slowest];

    /// The rate in baud.
    pub const fn baud(self) -> u32 {
        match self {
            Self::Fastest => 115_200,
            Self::Half => 57_600,
            Self::Third => 38_400,
            Self::Slowest => 9_600,
        }
    }

    /// Returns the rate with this number, modulo 4.
    pub const fn from_number(number: u8) -> Self {
        match number & 3 {
            0 => Self::Fastest,
            1 => Self::Half,
            2 => Self::Third,
            _ => Self::Slowest,
        }
    }

    /// Returns the next slower rate, or the fastest rate after the slowest.
    pub const fn next(self) -> Self {
        Self::from_number(self as u8 + 1)
    }
}
