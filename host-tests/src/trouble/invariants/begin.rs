//! When pulses may begin.

use simulated_uno::{Reset, ResetCause};

use super::Rules;
use crate::trouble::record::{Begin, MS, Record};

/// From a start to what `boot` says.
const BOOT: u64 = 3_000 * MS;

/// From an order to rest, to the end of the last pulse.
const UNTIL_REST: u64 = 45 * MS;

/// Pulses that begin so close to each other begin in one frame, or in two that follow:
/// servos are to wake 0.1 s apart.
const TOGETHER: u64 = 75 * MS;

/// Whether pulses may begin at a cycle, by all that has happened until then: the last
/// event that changes it decides.
pub fn may_begin(record: &Record, rules: &Rules, cycle: u64) -> bool {
    let mut last = (0, false);
    let mut note = |at: u64, may: bool| {
        if at <= cycle && at >= last.0 {
            last = (at, may);
        }
    };
    for (n, start) in record.starts.iter().enumerate() {
        if start.cause == ResetCause::PowerOn {
            note(start.cycle, true);
        }
        let next = record.starts.get(n + 1).map_or(u64::MAX, |next| next.cycle);
        // Somewhat early: the first tick comes before a frame has passed.
        let boot = start.cycle + BOOT - 25 * MS;
        let silent = record
            .bytes
            .iter()
            .all(|byte| !(start.cycle..boot).contains(byte));
        let hung = start.cause == ResetCause::Watchdog;
        if boot < next && silent && !hung && !rules.boots_to_rest {
            note(boot, true);
        }
    }
    for (heard, done) in record.orders() {
        match (heard.text.as_str(), done) {
            (_, Some(false)) => {}
            // An order acts with the next frame. One that trouble or another came before is perhaps
            // done, perhaps not.
            ("rest", _) => {
                let end = heard.cycle + UNTIL_REST;
                let troubled = record.starts_in(heard.cycle, end).next().is_some()
                    || record.is_disturbed(heard.cycle, end)
                    || record.was_ordered(heard.cycle + 1, end);
                if done.is_some() && !troubled {
                    note(end, false);
                }
            }
            _ => note(heard.cycle, true),
        }
    }
    for line in &record.lines {
        if line.text.ends_with("pulses ended") || line.text.contains("several times in a row") {
            note(line.cycle + UNTIL_REST, false);
        }
    }
    last.1
}

fn name(begin: &Begin) -> String {
    let ms = begin.pulse.start as f64 / MS as f64;
    format!("A{} begins at {ms:.3} ms", begin.servo + 1)
}

/// Only by a command, by `boot` or at power-on.
pub fn only_by_order(record: &Record, rules: &Rules) -> Result<(), String> {
    for begin in record.begins() {
        if !may_begin(record, rules, begin.pulse.start) {
            return Err(name(&begin));
        }
    }
    Ok(())
}

/// Whether a hang interrupted a servo's pulses, and nothing that hides where it is came
/// between.
pub fn is_after_a_hang(record: &Record, begin: &Begin) -> bool {
    let Some(before) = begin.before else {
        return false;
    };
    let (from, to) = (before.start, begin.pulse.start);
    // Before its second stage the watchdog has marked that the program hung: another reset
    // that comes first is taken for its.
    let hung = |start: &Reset| {
        start.cause == ResetCause::Watchdog
            || record.is_disturbed(start.cycle.saturating_sub(300 * MS), start.cycle)
    };
    let gone = |start: &Reset| {
        start.cause == ResetCause::PowerOn || start.cause == ResetCause::BrownOut && !hung(start)
    };
    record.starts_in(from, to).any(hung)
        && !record.starts_in(from, to).any(gone)
        && !record.was_ordered(from, to)
        && to - from < 1_000 * MS
}

/// One servo every 0.1 s, but for those that a hang interrupted.
pub fn one_after_another(record: &Record, _: &Rules) -> Result<(), String> {
    let begins = record.begins();
    for pair in begins.windows(2) {
        let together = pair[1].pulse.start - pair[0].pulse.start < TOGETHER;
        if together && !pair.iter().all(|begin| is_after_a_hang(record, begin)) {
            let apart = (pair[1].pulse.start - pair[0].pulse.start) as f64 / MS as f64;
            return Err(format!("{}, another {apart:.1} ms later", name(&pair[0])));
        }
    }
    Ok(())
}
