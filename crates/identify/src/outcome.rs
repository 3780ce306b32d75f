//! The result of an identification.

use crate::card::CardPose;
use crate::key::Key;
use crate::movement::MeasuredMovement;

/// The identified keys and their agreement with the measurements.
#[derive(Clone, Debug)]
pub struct Identification {
    /// The keys in the order of [`crate::KEYS`].
    pub keys: Vec<KeyResult>,
    /// Estimated position and direction of the card.
    pub card: CardPose,
    /// Standard errors of the card's parameters.
    pub card_error: CardPose,
    /// Pairs of keys whose errors have a correlation above 0.8 or below -0.8, with the correlation.
    pub correlated_pairs: Vec<(&'static Key, &'static Key, f64)>,
    /// Agreement of the model with the measured movements.
    pub goodness: GoodnessOfFit,
    /// The measured movements and the model's predictions.
    pub movements: Vec<MovementResult>,
}

/// The result for one key.
#[derive(Clone, Debug)]
pub struct KeyResult {
    /// The key of robot.toml.
    pub key: &'static Key,
    /// Value in the file.
    pub file_value: f64,
    /// Value with the best fit if the verdict is [`Verdict::Changed`]; otherwise the file's value.
    pub new_value: f64,
    /// Standard error of the value according to the measurements.
    pub error: f64,
    /// Decision about the key.
    pub verdict: Verdict,
}

/// A decision about a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The measurements contradict the file by at least two standard errors.
    Changed,
    /// The file's value agrees with the measurements.
    Unchanged,
    /// The measurements do not determine the key: its standard error stays above half of its prior standard deviation.
    Undetermined,
    /// The measurements require this value, which is below the smallest possible value; the file's value stays.
    Impossible(f64),
}

/// Agreement of the model with the measured movements.
#[derive(Clone, Copy, Debug)]
pub struct GoodnessOfFit {
    /// Number of measured values.
    pub value_count: usize,
    /// Sums of the squared residuals, each residual in units of its standard error: with the file's values, with the
    /// new values, and with all keys free. The card's pose is free in all three.
    pub chi_squares: [f64; 3],
    /// Number of measured values minus the effective number of parameters in the fit of all keys.
    pub degrees_of_freedom: f64,
    /// Sum of squares that 1 % of correct models exceed; 0 if there are no degrees of freedom.
    pub chi_square_limit: f64,
    /// True if the model explains the measurements: with all keys free, the sum of squares is at most
    /// `chi_square_limit`, or there are no degrees of freedom.
    pub is_explained: bool,
    /// Factor by which a bad fit enlarges all standard errors (Birge ratio); 1 for a good fit.
    pub error_factor: f64,
    /// The largest residual with the new values: movement index, component index, and residual in standard errors.
    pub largest_residual: (usize, usize, f64),
}

/// A measured movement and the model's predictions.
#[derive(Clone, Debug)]
pub struct MovementResult {
    /// The measured movement. A component that the model cannot predict has an infinite error and no weight; two feet
    /// then pull against the other two.
    pub measured: MeasuredMovement,
    /// The card's movement in the model with the file's values: forward and left in mm, turn in deg.
    pub predicted_before: [f64; 3],
    /// The card's movement in the model with the new values, in the same units.
    pub predicted_after: [f64; 3],
}

impl Identification {
    /// The keys with a new value.
    pub fn changed_keys(&self) -> impl Iterator<Item = &KeyResult> {
        self.keys.iter().filter(|result| result.is_changed())
    }
}

impl KeyResult {
    /// True if the key has a new value.
    pub(crate) fn is_changed(&self) -> bool {
        self.verdict == Verdict::Changed
    }

    /// Number of decimals with which the standard error has two significant digits.
    pub fn decimal_count(&self) -> usize {
        let first_digit_decimal = -self.error.log10().floor();
        (first_digit_decimal + 1.0).clamp(0.0, 6.0) as usize
    }
}
