//! What every pulse is, and how far it may be from the one before.

use lizard_core::console::word::Effect;
use simulated_uno::Pulse;

use super::Rules;
use super::begin::may_begin;
use crate::trouble::record::{Heard, MS, Record};

/// A pose is in the EEPROM so long after `rest`: the bytes of a record.
const KEPT_AFTER: u64 = 400 * MS;

/// The supply in good order, far from its first threshold, mV above it.
const WELL_ABOVE: f64 = 200.0;

/// Within the servo's travel, unless a reset or the supply has cut it.
pub fn within_travel(record: &Record, rules: &Rules) -> Result<(), String> {
    for (servo, seen) in record.pulses.iter().enumerate() {
        let (least, most) = rules.widths[servo];
        for seen in seen {
            let width = seen.pulse.width;
            let short = width < least && !seen.cut;
            // A falling edge that is held up comes late, at worst with the next slot.
            let long = width > most && !seen.held_up || width > 65_000;
            if short || long {
                let ms = seen.pulse.start as f64 / MS as f64;
                return Err(format!("A{} gets {width} cycles at {ms:.3} ms", servo + 1));
            }
        }
    }
    Ok(())
}

/// What came between two pulses of a servo.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Between {
    Nothing,
    /// A reset that left RAM alone, of a robot that had pulses.
    Reset,
    /// A reset of a robot that rested.
    ResetInRest,
    /// The pose is nowhere.
    Unknown,
}

/// How far pulses may be apart, for those with this between them.
fn leaps(record: &Record, rules: &Rules, between: Between) -> Result<(), String> {
    for (servo, seen) in record.pulses.iter().enumerate() {
        let whole: Vec<Pulse> = seen
            .iter()
            .filter(|seen| !seen.cut && !seen.held_up)
            .map(|seen| seen.pulse)
            .collect();
        for pair in whole.windows(2) {
            let leap = pair[0].width.abs_diff(pair[1].width);
            if leap > rules.way[servo] && what_came(record, rules, pair) == between {
                let ms = pair[1].start as f64 / MS as f64;
                return Err(format!(
                    "A{} has {} cycles and then {}, at {ms:.3} ms",
                    servo + 1,
                    pair[0].width,
                    pair[1].width,
                ));
            }
        }
    }
    Ok(())
}

fn what_came(record: &Record, rules: &Rules, pair: &[Pulse]) -> Between {
    let (from, to) = (pair[0].start, pair[1].start);
    let Some(start) = record.starts_in(from, to).next() else {
        let missed = record.holds.iter().any(|hold| hold.overlaps(from, to));
        return match missed {
            // Frames went by without a pulse.
            true => Between::Unknown,
            false => Between::Nothing,
        };
    };
    let rested = !may_begin(record, rules, start.cycle);
    if rested {
        let since = start.cycle.saturating_sub(from);
        let good = record.low_for(rules.slow + WELL_ABOVE, from, start.cycle) == 0;
        let calm = !record.is_disturbed(from, start.cycle);
        let saved = !has_unsaved_settings(record, start.cycle);
        if since > KEPT_AFTER && good && calm && saved {
            return Between::ResetInRest;
        }
        return Between::Unknown;
    }
    // A servo that was told to rest before it woke has no pulse to go over from.
    let rests =
        |(heard, _): (&Heard, _)| heard.text == "rest" && (start.cycle..to).contains(&heard.cycle);
    if record.orders().any(rests) {
        return Between::Unknown;
    }
    // A pose beyond the travel that was saved is none to wake in.
    if record.lost_power(from, to) || rules.narrowed {
        return Between::Unknown;
    }
    Between::Reset
}

/// Whether settings that change a pose's pulses may be in use and not saved.
fn has_unsaved_settings(record: &Record, until: u64) -> bool {
    let sets = |heard: &Heard| heard.effect == Effect::Calibrates || heard.text == "save";
    let set = record
        .heard
        .iter()
        .filter(|heard| heard.cycle < until && sets(heard));
    set.max_by_key(|heard| heard.cycle).is_some_and(|heard| {
        let saved = record.exchanges.iter().any(|exchange| {
            exchange.line == "save"
                && exchange.is_done()
                && exchange.asked <= heard.cycle
                && heard.cycle < exchange.asked + 10 * MS
        });
        !saved
    })
}

/// From frame to frame, whether main stalls or not.
pub fn no_leap(record: &Record, rules: &Rules) -> Result<(), String> {
    leaps(record, rules, Between::Nothing)
}

/// Across a reset of a robot that had pulses, or was about to have them.
pub fn no_leap_by_a_reset(record: &Record, rules: &Rules) -> Result<(), String> {
    leaps(record, rules, Between::Reset)
}

/// Across a reset, or a loss of power, of a robot that had rested for long enough.
pub fn rest_pose_is_kept(record: &Record, rules: &Rules) -> Result<(), String> {
    leaps(record, rules, Between::ResetInRest)
}
