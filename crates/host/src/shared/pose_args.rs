//! The options for a pose, and the bounds of quantities on the command line. Beyond the bounds, an f64 has too few
//! digits for an exact result.

use std::fmt;

use lizard_kinematics::Pose;

/// The servo angles' names in servo order, A1 to A4. Columns, flags and keys are in this order everywhere.
pub const ANGLE_NAMES: [&str; 4] = ["theta1", "theta4", "theta8", "theta5"];

/// A physical quantity with the largest absolute value allowed on the command line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    max: f64,
    unit: &'static str,
}

impl Quantity {
    /// An angle, degrees; the bound is about 2800 turns.
    pub const ANGLE: Self = Self::with_max(1e6, "degrees");
    /// A servo speed, deg/s.
    pub const RATE: Self = Self::with_max(1e6, "deg/s");
    /// A servo acceleration, deg/s^2.
    pub const ACCELERATION: Self = Self::with_max(1e9, "deg/s^2");
    /// A time, s.
    pub const TIME: Self = Self::with_max(1e9, "s");
    /// A length in units of D.
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NumberError {
    /// The text is not a number.
    NotANumber,
    /// The number is infinite, NaN, or too large for an f64.
    NotFinite,
    /// The number is outside the bounds of its quantity.
    OutOfRange(Quantity),
}

impl fmt::Display for NumberError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber => f.write_str("is not a number"),
            Self::NotFinite => f.write_str("is not a finite number"),
            Self::OutOfRange(Quantity { max, unit }) => {
                write!(f, "is not between -{max} and {max} {unit}")
            }
        }
    }
}

impl std::error::Error for NumberError {}

/// The options `--theta1`, `--theta4`, `--theta8` and `--theta5`.
#[derive(clap::Args, Debug, Default)]
#[command(allow_negative_numbers = true)]
pub struct PoseArgs {
    /// Servo A1, front left, degrees
    #[arg(long, value_name = "DEG", value_parser = Quantity::ANGLE.parser(), help_heading = "Pose",
          requires_all = ["theta4", "theta8", "theta5"])]
    theta1: Option<f64>,
    /// Servo A2, front right, degrees
    #[arg(long, value_name = "DEG", value_parser = Quantity::ANGLE.parser(), help_heading = "Pose",
          requires_all = ["theta1", "theta8", "theta5"])]
    theta4: Option<f64>,
    /// Servo A3, back right, degrees
    #[arg(long, value_name = "DEG", value_parser = Quantity::ANGLE.parser(), help_heading = "Pose",
          requires_all = ["theta1", "theta4", "theta5"])]
    theta8: Option<f64>,
    /// Servo A4, back left, degrees
    #[arg(long, value_name = "DEG", value_parser = Quantity::ANGLE.parser(), help_heading = "Pose",
          requires_all = ["theta1", "theta4", "theta8"])]
    theta5: Option<f64>,
}

impl PoseArgs {
    /// Returns the pose; `None` without options. clap accepts only all four options or none.
    pub fn to_pose(&self) -> Option<Pose> {
        Some(Pose {
            theta1: self.theta1?,
            theta4: self.theta4?,
            theta8: self.theta8?,
            theta5: self.theta5?,
        })
    }
}
