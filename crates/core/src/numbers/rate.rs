//! The baud rates of the serial line.

/// A baud rate of the serial line, from the fastest to the slowest. Its number survives a reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Rate {
    /// 115 200 baud, the rate of USB.
    #[default]
    Fastest,
    /// 57 600 baud.
    Half,
    /// 38 400 baud.
    Third,
    /// 9600 baud, the factory setting of most radio modules.
    Slowest,
}

impl Rate {
    /// All rates, in the order in which they are tried.
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

    /// The rate with this number, modulo 4.
    pub const fn from_number(number: u8) -> Self {
        match number & 3 {
            0 => Self::Fastest,
            1 => Self::Half,
            2 => Self::Third,
            _ => Self::Slowest,
        }
    }

    /// The next slower rate; after the slowest, the fastest.
    pub const fn next(self) -> Self {
        Self::from_number(self as u8 + 1)
    }
}
