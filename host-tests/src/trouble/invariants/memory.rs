//! What a low supply forbids, and when it counts as low.

use simulated_uno::ResetCause;

use super::Rules;
use crate::trouble::record::{MS, Record};

/// How exactly the robot measures, mV: a step of the converter and two decimals.
const EXACT: f64 = 40.0;

/// Six frames, less one before the first reading and one after the last; a reading stands
/// for two.
const SIX_FRAMES: u64 = 80 * MS;

/// Readings of a supply that has sunk are all low then: six frames and two readings.
const SURELY_LOW: u64 = 220 * MS;

/// The first reading is complete in the second frame.
const FIRST_READING: u64 = 20 * MS;

/// Brown-outs after which a robot gives up, and one for an order in between.
const MOST_BROWN_OUTS: usize = 5;

/// A supply that the servos pull down: the robot gives up, rests and says so.
pub fn brown_outs_end(record: &Record, _: &Rules) -> Result<(), String> {
    let fell = record
        .starts
        .iter()
        .filter(|start| start.cause == ResetCause::BrownOut);
    let fell: Vec<u64> = fell.map(|start| start.cycle).collect();
    for many in fell.windows(MOST_BROWN_OUTS + 1) {
        let (from, to) = (many[0], many[MOST_BROWN_OUTS]);
        if to - from < 4_000 * MS && !record.was_ordered(from, to) {
            let (count, seconds) = (fell.len(), (to - from) as f64 / MS as f64 / 1_000.0);
            return Err(format!("{} of {count} in {seconds:.1} s", many.len()));
        }
    }
    Ok(())
}

/// A level is left for a worse one after six frames that are worse.
pub fn supply_acts_on_six_frames(record: &Record, rules: &Rules) -> Result<(), String> {
    for line in &record.lines {
        let Some(text) = line.text.strip_prefix("# supply: ") else {
            continue;
        };
        let threshold = if text.ends_with("pulses ended") {
            rules.rest
        } else if text.ends_with("stopped") {
            rules.stop
        } else {
            continue;
        };
        let from = line.cycle.saturating_sub(500 * MS);
        let low = record.low_for(threshold + EXACT, from, line.cycle);
        if low < SIX_FRAMES {
            let low = low as f64 / MS as f64;
            return Err(format!("{:?}, below for {low:.1} ms", line.text));
        }
    }
    Ok(())
}

/// Nothing is written below `slow`, nor before the supply has been measured.
pub fn written_only_when_allowed(record: &Record, rules: &Rules) -> Result<(), String> {
    for write in &record.written {
        let at = write.cycle;
        let start = record.start_before(at).map_or(0, |start| start.cycle);
        if at - start < FIRST_READING {
            let us = (at - start) / 16;
            return Err(format!("byte {} {us} us after a start", write.address));
        }
        let from = at.saturating_sub(SURELY_LOW);
        if at > SURELY_LOW && record.low_for(rules.slow - EXACT, from, at) == SURELY_LOW {
            return Err(format!("byte {} at {} ms, too low", write.address, at / MS));
        }
    }
    Ok(())
}

/// A second `rest`: the pose is kept already.
pub fn rest_again_writes_nothing(record: &Record, _: &Rules) -> Result<(), String> {
    const WHILE: u64 = 150 * MS;
    let rests: Vec<_> = record
        .exchanges
        .iter()
        .filter(|one| one.line == "rest" && one.is_done())
        .collect();
    for pair in rests.windows(2) {
        let (first, again) = (pair[0].asked, pair[1].asked);
        let end = again + WHILE;
        let calm = !record.was_ordered(first + 10 * MS, again)
            && !record.was_ordered(again + 10 * MS, end)
            && record.starts_in(first, end).next().is_none()
            && again > first + 2 * WHILE;
        let written = record
            .written
            .iter()
            .filter(|write| (again..end).contains(&write.cycle))
            .count();
        if calm && written > 0 {
            return Err(format!("{written} bytes after {} ms", again / MS));
        }
    }
    Ok(())
}
