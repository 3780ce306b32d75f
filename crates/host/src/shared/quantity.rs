//! The bounds of quantities on the command line. Beyond the bounds, an f64 has too few digits for an accurate result.

/// A physical quantity with the largest absolute value allowed on the command line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    max: f64,
    unit: &'static str,
}

impl Quantity {
    /// An angle, degrees; the bound is about 2800 turns.
    pub const ANGLE: Self = Self::with_max(1e6, "degrees");
    /// An angular rate, deg/s.
    pub const RATE: Self = Self::with_max(1e6, "deg/s");
    /// An angular acceleration, deg/s^2.
    pub const ACCELERATION: Self = Self::with_max(1e9, "deg/s^2");
    /// A time, s.
    pub const TIME: Self = Self::with_max(1e9, "s");
    /// A length divided by the paper's dimensional factor D.
    pub const PROPORTION: Self = Self::with_max(1e6, "D");
    /// A coordinate or a length, mm.
    pub const LENGTH: Self = Self::with_max(1e6, "mm");

    const fn with_max(max: f64, unit: &'static str) -> Self {
        Self { max, unit }
    }

    /// Returns a clap parser for this quantity.
    pub fn parser(self) -> impl Fn(&str) -> Result<f64, String> + Clone {
        move |text| self.parse(text).map_err(|error| format!("it {error}"))
    }

    /// Parses a number and checks its bounds.
    ///
    /// # Errors
    /// Fails if the text is not a number, or if the number is out of bounds; NaN and infinity are out of bounds.
    pub fn parse(self, text: &str) -> Result<f64, NumberError> {
        match text.parse::<f64>() {
            Ok(value) if value.abs() <= self.max => Ok(value),
            Ok(value) if !value.is_finite() => Err(NumberError::NotFinite),
            Ok(_) => Err(NumberError::OutOfRange(self)),
            Err(_) => Err(NumberError::NotANumber),
        }
    }
}

/// An error in a number on the command line. The message completes a sentence that begins with the number.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NumberError {
    /// The text is not a number.
    #[error("is not a number")]
    NotANumber,
    /// The number is infinite, NaN, or too large for an f64.
    #[error("is not a finite number")]
    NotFinite,
    /// The number is outside the bounds of its quantity.
    #[error("is not between -{max} and {max} {unit}", max = .0.max, unit = .0.unit)]
    OutOfRange(Quantity),
}
