//! Rounding and formatting of numbers for human readers, and numbers in a range on the command line.

use std::fmt::Display;
use std::str::FromStr;

/// Rounds a value to `decimals` decimal places, for printing. The result is never -0.0.
pub fn round_to_decimals(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    // Adding 0.0 turns -0.0 into 0.0.
    (value * scale).round() / scale + 0.0
}

/// Returns a parser for numbers between `min` and `max`; `unit`, with a space before it, is for the error message.
pub fn range_parser(
    min: f64,
    max: f64,
    unit: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| match text.parse::<f64>() {
        Ok(value) if (min..=max).contains(&value) => Ok(value),
        _ => Err(format!("must be between {min} and {max}{unit}")),
    }
}

/// Returns a parser for whole numbers between `min` and `max`.
pub fn whole_number_parser<T: Copy + Display + FromStr + PartialOrd>(
    min: T,
    max: T,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| match text.parse::<T>() {
        Ok(value) if (min..=max).contains(&value) => Ok(value),
        _ => Err(format!("must be a whole number from {min} to {max}")),
    }
}

/// Formats a number with `decimals` decimal places; a missing number becomes a dash.
pub fn format_or_dash(value: Option<f64>, decimals: usize) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.decimals$}"))
}

/// Formats a number that is not negative, with spaces between groups of three digits.
pub fn group_digits(value: f64, decimals: usize) -> String {
    let ungrouped = format!("{value:.decimals$}");
    let (integer, fraction) = ungrouped.split_at(ungrouped.find('.').unwrap_or(ungrouped.len()));
    let mut text = String::new();
    for (index, digit) in integer.chars().enumerate() {
        if index > 0 && (integer.len() - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text + fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_of_three_digits_are_separated_by_spaces() {
        for (value, decimals, text) in [
            (0.0, 0, "0"),
            (999.4, 0, "999"),
            (16_384.0, 0, "16 384"),
            (1_234_567.89, 1, "1 234 567.9"),
        ] {
            assert_eq!(group_digits(value, decimals), text);
        }
    }

    #[test]
    fn a_value_that_rounds_to_zero_has_no_sign() {
        for value in [-0.0, 0.0, -0.00049, 0.00049] {
            assert_eq!(format!("{:+.3}", round_to_decimals(value, 3)), "+0.000");
        }
        assert_eq!(format!("{:.3}", round_to_decimals(-0.0005, 3)), "-0.001");
        assert_eq!(format!("{:.2}", round_to_decimals(-319.987, 2)), "-319.99");
    }
}
