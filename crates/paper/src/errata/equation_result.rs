//! The result for one printed equation, as numbers and in words.

use serde::Serialize;

/// The errors of an equation and of its correction.
#[derive(Serialize)]
pub struct EquationResult {
    /// The equation's section and name in the paper.
    #[serde(rename = "place")]
    pub location: &'static str,
    /// The equation as printed.
    #[serde(rename = "printed")]
    pub printed_form: &'static str,
    /// True if the printed form holds at every sample.
    pub holds: bool,
    /// The largest error of the printed form, in `unit`.
    #[serde(rename = "worst")]
    pub max_error: f64,
    /// Fraction of the samples at which the printed form has no real value.
    #[serde(rename = "unreal")]
    pub no_real_value_fraction: f64,
    /// The unit of every error of this equation.
    pub unit: &'static str,
    /// The largest error of the printed form in a special case, in `unit`, and the special case's name; `None` if there
    /// is no special case.
    #[serde(rename = "aside")]
    pub special_case: Option<(f64, &'static str)>,
    /// True if the printed form holds with the angles of the robot's right side measured clockwise from -x; `None` if
    /// the drawings do not suggest this convention.
    pub holds_clockwise: Option<bool>,
    /// The corrected form; `None` if the printed form needs no correction.
    #[serde(rename = "corrected")]
    pub corrected_form: Option<&'static str>,
    /// The largest error of the corrected form, in `unit`.
    #[serde(rename = "corrected_worst")]
    pub corrected_max_error: Option<f64>,
    /// True if the corrected form holds at every sample.
    pub corrected_holds: Option<bool>,
}

impl EquationResult {
    /// The verdict on the printed form, in words.
    pub fn verdict(&self) -> &'static str {
        match (self.holds, self.holds_clockwise) {
            (true, Some(false)) => "holds, but not clockwise",
            (true, _) => "holds",
            (false, Some(true)) => "fails; holds clockwise",
            (false, _) => "fails",
        }
    }

    /// Formats the largest error, or `rounding` if the equation holds, followed by the error of the special case.
    pub fn format_error(&self) -> String {
        let mut text = self.format_max_error();
        if let Some((max_error, special_case)) = self.special_case {
            let (error, unit) = (format_three_digits(max_error), self.unit);
            text += &format!("; {error} {unit} at {special_case}");
        }
        text
    }

    /// Formats the largest error, or `rounding` if the equation holds, without the special case.
    fn format_max_error(&self) -> String {
        if self.holds {
            return "rounding".to_string();
        }
        let mut text = format!("{} {}", format_three_digits(self.max_error), self.unit);
        if self.no_real_value_fraction >= 0.999_95 {
            text = "no real value".to_string();
        } else if self.no_real_value_fraction > 0.0 {
            let percentage = 100.0 * self.no_real_value_fraction;
            text += &format!(", no real value at {percentage:.0} % of poses");
        }
        text
    }

    /// True if the printed or the corrected form holds.
    pub fn has_valid_form(&self) -> bool {
        self.holds || self.corrected_holds == Some(true)
    }
}

/// Formats a value with three significant digits, without an exponent.
fn format_three_digits(value: f64) -> String {
    let decimals = (2 - value.abs().max(1e-9).log10().floor() as i32).clamp(0, 9);
    format!("{value:.0$}", decimals as usize)
}
