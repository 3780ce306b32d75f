//! Prints the table of measurements and budgets as text.

use std::io::{self, Write};

use super::budget::{Bound, BudgetRow, SERVO_LIBRARY_SETUP};
use crate::shared::number::group_digits;

/// Prints a row for each measurement, then notes about missing values and the measured `gait`, which is `None` if the
/// robot has no moving gait.
///
/// # Errors
/// Fails if writing fails.
pub fn print(rows: &[BudgetRow], gait: Option<&str>, out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "{:<30} {:>10} {:<7} {:>16}   Arduino Servo",
        "", "measured", "", "budget"
    )?;
    for row in rows {
        let budget = match row.budget {
            Bound::AtMost(max) => format!("at most {}", group_digits(max, 0)),
            Bound::AtLeast(min) => format!("at least {}", group_digits(min, 0)),
            Bound::None => "-".to_owned(),
        };
        let decimals = match row.unit {
            "%" | "s" => 1,
            _ => 0,
        };
        let measured = row.measured.map(|value| group_digits(value, decimals));
        let measured = measured.as_deref().unwrap_or("-");
        let servo_library = row.servo_library.unwrap_or("");
        let mark = if row.is_within_budget {
            ""
        } else {
            "  OVER BUDGET"
        };
        let line = format!(
            "{:<30} {measured:>10} {:<7} {budget:>16}   {servo_library}{mark}",
            row.name, row.unit
        );
        writeln!(out, "{}", line.trim_end())?;
    }
    let gait_note = match gait {
        Some(gait) => format!("The gait is {gait}."),
        None => "-: not measured, because this robot has no moving gait.".to_owned(),
    };
    let lacks_width_error =
        |row: &BudgetRow| row.name == "width minus command, worst" && row.measured.is_none();
    if rows.iter().any(lacks_width_error) {
        writeln!(
            out,
            "\nThis firmware was not built from the same source and robot.toml as this program; \
             its widths were not compared."
        )?;
    }
    writeln!(
        out,
        "\nA cycle is 62.5 ns. {gait_note} {SERVO_LIBRARY_SETUP}."
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_over_its_budget_is_marked() {
        let budget = Bound::AtMost(16_384.0);
        let row = BudgetRow::new("flash", "bytes", Some(20_000.0), budget, Some("5 994"));
        let mut text = Vec::new();
        print(&[row], None, &mut text).expect("writing to a vector succeeds");
        let text = String::from_utf8(text).expect("the table is UTF-8");
        assert!(text.contains("20 000 bytes"), "{text}");
        assert!(
            text.contains("at most 16 384   5 994  OVER BUDGET"),
            "{text}"
        );
    }
}
