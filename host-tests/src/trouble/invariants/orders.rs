//! What is answered is done, and what is refused is not.

use lizard_core::console::word::Effect;

use super::Rules;
use crate::trouble::record::{Exchange, MS, Record};

/// From an order to stand to the pulses of all four servos.
const UNTIL_AWAKE: u64 = 600 * MS;

/// A tick, and the frame under way.
const A_FRAME: u64 = 25 * MS;

fn answers(record: &Record) -> impl Iterator<Item = (&Exchange, u64)> {
    let answered = record.exchanges.iter();
    answered.filter_map(|exchange| Some((exchange, exchange.answer.as_ref()?.cycle)))
}

/// Whether anything but the robot itself ends pulses in `from..to`.
fn is_troubled(record: &Record, rules: &Rules, from: u64, to: u64) -> bool {
    record.starts_in(from, to).next().is_some()
        || record.cuts.iter().any(|cut| (from..to).contains(cut))
        || record.is_disturbed(from, to)
        || record.low_for(rules.rest + 40.0, from.saturating_sub(400 * MS), to) > 0
}

/// `ok` to a motion: all four servos have pulses soon.
pub fn done_means_pulses(record: &Record, rules: &Rules) -> Result<(), String> {
    for (exchange, at) in answers(record) {
        let end = at + UNTIL_AWAKE;
        let next = record
            .orders()
            .any(|(heard, _)| (at..end).contains(&heard.cycle));
        let judged =
            exchange.effect == Effect::Moves && exchange.is_done() && end < record.end && !next;
        if !judged || is_troubled(record, rules, at, end) {
            continue;
        }
        if let Some(servo) = (0..4).find(|servo| !record.servo_has_pulses(*servo, at, end)) {
            let (line, at) = (&exchange.line, at / MS);
            return Err(format!(
                "ok {line} at {at} ms, and A{} has no pulses",
                servo + 1
            ));
        }
    }
    Ok(())
}

/// No pulses for 0.4 s around a `status`: it says that the robot rests, or a fault.
pub fn status_says_why(record: &Record, rules: &Rules) -> Result<(), String> {
    const AROUND: u64 = 200 * MS;
    for (exchange, at) in answers(record) {
        let (Some(gait), Some(fault)) = (exchange.status("gait"), exchange.status("fault")) else {
            continue;
        };
        let (from, to) = (at.saturating_sub(AROUND), at + AROUND);
        let ordered = record.was_ordered(from.saturating_sub(AROUND), to);
        if ordered || to > record.end || is_troubled(record, rules, from.saturating_sub(AROUND), to)
        {
            continue;
        }
        if !record.has_pulses(from, to) && gait != "rest" && fault == "none" {
            return Err(format!(
                "no pulses at {} ms, and gait={gait} fault=none",
                at / MS
            ));
        }
    }
    Ok(())
}

/// `gait=rest`: there are no pulses, until an order.
pub fn rest_is_rest(record: &Record, rules: &Rules) -> Result<(), String> {
    for (exchange, at) in answers(record) {
        let end = at + 140 * MS;
        let rests = exchange.status("gait") == Some("rest");
        if !rests || record.was_ordered(at, end) || is_troubled(record, rules, at, end) {
            continue;
        }
        if record.has_pulses(at + A_FRAME, end) {
            return Err(format!("gait=rest at {} ms, and pulses", at / MS));
        }
    }
    Ok(())
}

/// `ok rest`: no pulse begins later than a frame after it.
pub fn rest_ends_pulses(record: &Record, _: &Rules) -> Result<(), String> {
    for (exchange, at) in answers(record) {
        let end = at + 140 * MS;
        let rests = exchange.line == "rest" && exchange.is_done();
        // A main that is stalled computes no frame.
        if rests
            && !record.is_disturbed(exchange.asked, end)
            && !record.lost_power(at, end)
            && !record.was_ordered(at, end)
            && record.has_pulses(at + A_FRAME, end.min(record.end))
        {
            return Err(format!("ok rest at {} ms, and pulses go on", at / MS));
        }
    }
    Ok(())
}

/// The last `stand` of the scenario, long after all trouble.
pub fn stand_stands(record: &Record, _: &Rules) -> Result<(), String> {
    let mut exchanges = record.exchanges.iter().rev();
    let status = exchanges.next().ok_or("nothing was asked")?;
    let stand = exchanges
        .find(|exchange| exchange.line == "stand")
        .ok_or("no stand")?;
    if !stand.is_done() {
        return Err(format!("stand is answered by {:?}", stand.answer));
    }
    if status.status("gait") != Some("stand") || status.status("fault") != Some("none") {
        return Err(format!("after stand: {:?}", status.answer));
    }
    let last = record.end - 110 * MS;
    for (servo, seen) in record.pulses.iter().enumerate() {
        let widths: Vec<u64> = seen
            .iter()
            .filter(|seen| seen.pulse.start > last)
            .map(|seen| seen.pulse.width)
            .collect();
        let steady = widths.windows(2).all(|pair| pair[0] == pair[1]);
        if widths.len() < 4 || !steady {
            return Err(format!("A{} gets {widths:?} at last", servo + 1));
        }
    }
    Ok(())
}

/// A command with an `err` between two questions: what they tell is the same.
pub fn refused_changes_nothing(record: &Record, rules: &Rules) -> Result<(), String> {
    for three in record.exchanges.windows(3) {
        let [before, refused, after] = three else {
            continue;
        };
        let answer = refused.answer.as_ref();
        let is_refused = answer.is_some_and(|line| line.text.starts_with("err"));
        let (Some(from), Some(to)) = (&before.answer, &after.answer) else {
            continue;
        };
        let are_told = before.status("gait").is_some() && after.status("gait").is_some();
        if !is_refused || !are_told || is_troubled(record, rules, from.cycle, to.cycle) {
            continue;
        }
        for key in ["gait", "speed", "guard", "fault", "reset", "resets"] {
            if before.status(key) != after.status(key) {
                return Err(format!(
                    "{}: {} and then {}",
                    refused.line, from.text, to.text
                ));
            }
        }
    }
    Ok(())
}

/// Lines that no robot may take.
pub fn wrong_is_refused(record: &Record, _: &Rules) -> Result<(), String> {
    let wrong = [
        "nonsense",
        "trim 1 90",
        "speed 5",
        "limit 2 1 2",
        "boot walk 1",
        "pose 0 0 0 0",
    ];
    for exchange in &record.exchanges {
        if wrong.contains(&exchange.line.as_str()) && exchange.is_done() {
            return Err(format!("{:?}", exchange.answer));
        }
    }
    Ok(())
}
