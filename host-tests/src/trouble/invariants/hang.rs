//! What a hang does: it has an effect or ends in a reset, and the pose is held.

use simulated_uno::ResetCause;

use super::Rules;
use super::begin::is_after_a_hang;
use crate::trouble::record::{MS, Record};

/// From the end of the pulses to the reset of a hang: the watchdog's second stage, whose
/// clock is as exact as the simulation's, and a frame.
const UNTIL_RESET: u64 = 160 * MS;

/// A stall that is shorter resets nothing: the watchdog's first stage, less the frame in
/// which it was fed. That stage ends the pulses, and then the reset is waited for.
const HARMLESS: u64 = 100 * MS;

/// Held after a hang, in the pose of the last frame.
pub fn held_where_it_was(record: &Record, rules: &Rules) -> Result<(), String> {
    for begin in record.begins() {
        let Some(before) = begin.before else { continue };
        let leap = begin.pulse.width.abs_diff(before.width);
        // One frame may have been computed and not yet played.
        if is_after_a_hang(record, &begin) && !begin.cut && leap > rules.way[begin.servo] {
            return Err(format!(
                "A{} had {} cycles before and {} after, at {} ms",
                begin.servo + 1,
                before.width,
                begin.pulse.width,
                begin.pulse.start / MS
            ));
        }
    }
    Ok(())
}

/// Every end of all pulses has its reason: an order, a reset, the supply, `boot`; where
/// it has none the program hung, and then a reset follows.
pub fn silence_has_a_reason(record: &Record, rules: &Rules) -> Result<(), String> {
    for silence in record.silences(80 * MS) {
        let at = silence.start;
        let told = record.orders().any(|(heard, done)| {
            heard.text == "rest"
                && done != Some(false)
                && (heard.cycle..heard.cycle + 425 * MS).contains(&(at + 25 * MS))
        });
        let cut = |cut: &u64| {
            (*cut..*cut + 25 * MS).contains(&at) || (at..at + UNTIL_RESET).contains(cut)
        };
        let by_supply = record.low_for(rules.rest + 40.0, at.saturating_sub(600 * MS), at) > 0;
        let booted = |line: &&lizard_host::sim::lines::Line| line.text == "# boot: rest";
        let boot = record
            .lines
            .iter()
            .filter(booted)
            .any(|line| line.cycle.abs_diff(at) < 60 * MS);
        let restarted = record
            .starts_in(at.saturating_sub(25 * MS), at + UNTIL_RESET)
            .next();
        let restarted = restarted.is_some();
        let unfinished = silence.end == record.end && silence.end - at < UNTIL_RESET;
        let explained =
            told || by_supply || boot || restarted || unfinished || record.cuts.iter().any(cut);
        if !explained {
            let (at, ms) = (at / MS, (silence.end - at) / MS);
            return Err(format!(
                "the pulses end at {at} ms, for {ms} ms, and no reset comes"
            ));
        }
    }
    Ok(())
}

/// The watchdog resets only a program that has hung for long.
pub fn no_reset_without_need(record: &Record, _: &Rules) -> Result<(), String> {
    for start in &record.starts {
        if start.cause != ResetCause::Watchdog {
            continue;
        }
        let hung = |span: &&crate::trouble::record::Span| {
            span.overlaps(start.cycle.saturating_sub(300 * MS), start.cycle + 1)
        };
        // Several short ones may add up.
        let total: u64 = record
            .stalls
            .iter()
            .filter(hung)
            .map(|span| span.end - span.start)
            .sum();
        if total < HARMLESS {
            return Err(format!(
                "a reset at {} ms, stalled for {} ms",
                start.cycle / MS,
                total / MS
            ));
        }
    }
    Ok(())
}
