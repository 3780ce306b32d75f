//! The reason for a stop is reported: by `status`, on the console, by the LED.

use lizard_core::console::word::Effect;
use lizard_host::sim::lines::Line;
use simulated_uno::{Edge, Pin, ResetCause, State};

use super::Rules;
use crate::trouble::record::{MS, Record};

/// The words of `fault=`, by their code.
const FAULTS: [&str; 8] = [
    "none", "guard", "supply", "link", "watchdog", "late", "stack", "brownout",
];

/// From what stops the robot to its report.
const UNTIL_SAID: u64 = 300 * MS;

/// The LED.
const LED: Pin = Pin::d(13);

/// Neither crashed nor halted.
pub fn it_lives(record: &Record, _: &Rules) -> Result<(), String> {
    match &record.state {
        State::Alive => Ok(()),
        other => Err(format!("{other:?}")),
    }
}

/// An answer to each line, unless the board was reset or stalled meanwhile.
pub fn every_line_is_answered(record: &Record, _: &Rules) -> Result<(), String> {
    for exchange in &record.exchanges {
        let (from, to) = (exchange.asked, exchange.asked + 400 * MS);
        let troubled = record
            .starts_in(from.saturating_sub(MS), to)
            .next()
            .is_some()
            || record.cuts.iter().any(|cut| (from..to).contains(cut))
            || record.is_disturbed(from, to);
        if exchange.answer.is_none() && !troubled {
            return Err(format!("{} at {} ms", exchange.line, from / MS));
        }
    }
    Ok(())
}

/// Whether the robot was told to move in `from..to`, or may have been.
fn was_told(record: &Record, from: u64, to: u64) -> bool {
    let mut orders = record.orders();
    orders.any(|(heard, done)| {
        heard.effect == Effect::Moves && done != Some(false) && (from..to).contains(&heard.cycle)
    })
}

/// A hang and a low supply are reported, and stay reported until a command.
pub fn stops_are_told(record: &Record, rules: &Rules) -> Result<(), String> {
    let statuses = record.exchanges.iter().filter_map(|exchange| {
        let at = exchange.answer.as_ref()?.cycle;
        Some((at, exchange.status("fault")?, exchange.status("reset")?))
    });
    let statuses: Vec<(u64, &str, &str)> = statuses.collect();
    for (at, fault, reset) in &statuses {
        let Some(start) = record.start_before(*at) else {
            continue;
        };
        let told = was_told(record, start.cycle, *at);
        if start.cause == ResetCause::Watchdog && start.cycle + UNTIL_SAID < *at {
            if *reset != "watchdog" || !told && *fault == "none" {
                return Err(format!(
                    "hung at {} ms: fault={fault} reset={reset}",
                    start.cycle / MS
                ));
            }
            let said = |line: &&Line| line.text.starts_with("# fault: ");
            let mut said = record.lines.iter().filter(said);
            if !said.any(|line| (start.cycle..*at).contains(&line.cycle)) {
                return Err(format!(
                    "hung at {} ms, and no line says so",
                    start.cycle / MS
                ));
            }
        }
        let from = at.saturating_sub(400 * MS).max(start.cycle);
        let low = record.low_for(rules.stop - 40.0, from, *at) == 400 * MS;
        if low && *fault == "none" {
            return Err(format!("the supply is low at {} ms: fault=none", at / MS));
        }
    }
    for pair in statuses.windows(2) {
        let [(from, before, _), (to, after, _)] = pair else {
            continue;
        };
        let restarted = record.starts_in(*from, *to).next().is_some();
        if *before != "none" && *after == "none" && !restarted && !was_told(record, *from, *to) {
            return Err(format!("fault={before}, then none at {} ms", to / MS));
        }
    }
    Ok(())
}

/// The LED from what `status` tells to the next order.
pub fn led_shows_the_fault(record: &Record, _: &Rules) -> Result<(), String> {
    let statuses = record
        .exchanges
        .iter()
        .filter_map(|exchange| Some((exchange.answer.as_ref()?.cycle, exchange.status("fault")?)));
    let led: Vec<&Edge> = record.edges.iter().filter(|edge| edge.pin == LED).collect();
    for (at, fault) in statuses {
        let code = FAULTS.iter().position(|word| *word == fault);
        let code = code.ok_or_else(|| format!("fault={fault} is not known"))?;
        // From the line that says so, or the start, or the last order.
        let said = record.lines.iter().filter(|line| {
            (line.text.starts_with("# fault") || line.text.starts_with("# held")) && line.cycle < at
        });
        let orders = record.orders().filter(|(heard, _)| heard.cycle < at);
        let from = said.map(|line| line.cycle);
        let from = from.chain(orders.map(|(heard, _)| heard.cycle));
        let from = from.chain(
            record
                .starts
                .iter()
                .map(|start| start.cycle)
                .filter(|start| *start < at),
        );
        // What is lit from before is no flash of this pattern.
        let from = from.max().unwrap_or(0) + 60 * MS;
        if record.is_disturbed(from.saturating_sub(100 * MS), at) {
            continue;
        }
        shows(&led, from, at, code)
            .map_err(|seen| format!("fault={fault} at {} ms: {seen}", at / MS))?;
    }
    Ok(())
}

/// Whether the LED shows nothing but this code in `from..to`.
fn shows(led: &[&Edge], from: u64, to: u64, code: usize) -> Result<(), String> {
    let mut flashes = None;
    for pair in led.windows(2) {
        if pair[0].cycle < from || pair[1].cycle > to {
            continue;
        }
        let ms = (pair[1].cycle - pair[0].cycle) / MS;
        match (pair[0].high, ms) {
            (true, 150..=170) if code > 0 => flashes = flashes.map(|n: usize| n + 1),
            (false, 150..=170) if code > 0 => {}
            (false, 1_100..=1_140) if code > 0 => {
                if flashes.is_some_and(|n| n != code) {
                    return Err(format!("the LED flashes {flashes:?} times"));
                }
                flashes = Some(0);
            }
            (_, 630..=650) if code == 0 => {}
            (high, ms) => return Err(format!("the LED is high={high} for {ms} ms")),
        }
    }
    Ok(())
}

/// `deadman n`: no line has come for n ms when the robot says so.
pub fn deadman_is_not_early(record: &Record, _: &Rules) -> Result<(), String> {
    /// Cycles of a byte.
    const BYTE: u64 = 1_360;
    let set = |text: &str| text.strip_prefix("deadman ")?.parse::<u64>().ok();
    for line in record
        .lines
        .iter()
        .filter(|line| line.text.contains("deadman says"))
    {
        let before = record
            .heard
            .iter()
            .filter(|heard| heard.cycle < line.cycle && !heard.text.is_empty());
        let Some(last) = before.clone().map(|heard| heard.cycle).max() else {
            continue;
        };
        let Some(ms) = before.filter_map(|heard| set(&heard.text)).next_back() else {
            continue;
        };
        let said = line.cycle - BYTE * line.text.len() as u64;
        if said < last + ms * MS {
            return Err(format!(
                "deadman {ms}, and stopped after {} ms",
                said.saturating_sub(last) / MS
            ));
        }
    }
    Ok(())
}
