//! The LED's patterns. For a fault, the LED flashes as many times as the fault's code, then pauses. Without a fault,
//! the LED blinks slowly and regularly.

use std::ops::RangeInclusive;

use crate::event::{MS, Time};

/// The duration of a flash, and of the dark interval between two flashes.
const FLASH_MS: RangeInclusive<Time> = 150..=170;
/// The duration of the pause after the flashes of a fault.
const PAUSE_MS: RangeInclusive<Time> = 1_100..=1_140;
/// The time for which the LED is on, and then off, while there is no fault.
const BLINK_MS: RangeInclusive<Time> = 630..=650;

/// The words after `fault=` in `status`. The index of a word is the fault's code. `robot` is missing, because the tools
/// always run a robot.
const FAULT_WORDS: [&str; 8] = [
    "none", "guard", "supply", "link", "watchdog", "late", "stack", "brownout",
];

/// Returns the code of a fault from its word in `status`.
///
/// # Errors
/// Returns a message if no fault has this word.
pub fn fault_code(fault: &str) -> Result<u8, String> {
    let code = FAULT_WORDS.iter().position(|word| *word == fault);
    code.map(|code| code as u8)
        .ok_or_else(|| format!("fault={fault}: unknown fault"))
}

/// Checks that the LED shows only the pattern of the fault `code` in `from..to`; code 0 means no fault. `edges` are the
/// LED's changes: a time, and true if the LED was switched on.
///
/// # Errors
/// Returns a message about an LED that does not change, or about the first flash, pause or count that does not match
/// this code.
pub fn check_pattern(edges: &[(Time, bool)], from: Time, to: Time, code: u8) -> Result<(), String> {
    let mut last_change = from;
    let times = edges.iter().map(|(time, _)| *time);
    let changes = times.filter(|time| (from..to).contains(time));
    for time in changes.chain([to]) {
        let ms = (time - last_change) / MS;
        if ms > *PAUSE_MS.end() {
            return Err(format!("fault {code}: no change for {ms} ms"));
        }
        last_change = time;
    }
    let mut flash_count = None;
    for pair in edges.windows(2) {
        let ((start, is_on), (end, _)) = (pair[0], pair[1]);
        if start < from || end > to {
            continue;
        }
        let ms = (end - start) / MS;
        if code > 0 && FLASH_MS.contains(&ms) {
            flash_count = flash_count.map(|count: u8| count + u8::from(is_on));
        } else if code > 0 && !is_on && PAUSE_MS.contains(&ms) {
            // The count before the first pause is incomplete, so it is not checked.
            if let Some(count) = flash_count
                && count != code
            {
                let message = format!("fault {code}: expected {code} flashes, got {count}");
                return Err(message);
            }
            flash_count = Some(0);
        } else if code > 0 || !BLINK_MS.contains(&ms) {
            let start_ms = start as f64 / MS as f64;
            return Err(format!(
                "fault {code}: unexpected interval of {ms} ms (LED on: {is_on}) from {start_ms:.3} ms on"
            ));
        }
    }
    Ok(())
}
