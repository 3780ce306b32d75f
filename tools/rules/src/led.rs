//! The LED's patterns: for a fault, as many short flashes as its code, then a pause; without a
//! fault, a slow beat.

use crate::event::{MS, Time};

/// The words of `fault=` in `status`; the index is the fault's code.
const FAULTS: [&str; 8] = [
    "none", "guard", "supply", "link", "watchdog", "late", "stack", "brownout",
];

/// Returns the code of a fault from its word in `status`.
///
/// # Errors
/// Fails if `status` has no such word.
pub fn code(fault: &str) -> Result<u8, String> {
    let code = FAULTS.iter().position(|word| *word == fault);
    code.map(|code| code as u8)
        .ok_or_else(|| format!("fault={fault} is not known"))
}

/// Checks that the LED shows only the pattern of the fault `code` in `from..to`; 0 is no fault.
/// `edges` are the LED's changes: a time, and true if it was switched on.
///
/// # Errors
/// Returns a message about the first flash, pause or count that does not fit this code.
pub fn check_pattern(edges: &[(Time, bool)], from: Time, to: Time, code: u8) -> Result<(), String> {
    let mut flashes = None;
    for pair in edges.windows(2) {
        if pair[0].0 < from || pair[1].0 > to {
            continue;
        }
        let ms = (pair[1].0 - pair[0].0) / MS;
        match (pair[0].1, ms) {
            (true, 150..=170) if code > 0 => flashes = flashes.map(|n: u8| n + 1),
            (false, 150..=170) if code > 0 => {}
            (false, 1_100..=1_140) if code > 0 => {
                // None until the first pause: the count before it is incomplete.
                if let Some(count) = flashes
                    && count != code
                {
                    return Err(format!("fault {code}: the LED flashes {count} times"));
                }
                flashes = Some(0);
            }
            (_, 630..=650) if code == 0 => {}
            (is_high, ms) => {
                let start_ms = pair[0].0 as f64 / MS as f64;
                let message =
                    format!("the LED is high={is_high} for {ms} ms from {start_ms:.3} ms on");
                return Err(format!("fault {code}: {message}"));
            }
        }
    }
    Ok(())
}
