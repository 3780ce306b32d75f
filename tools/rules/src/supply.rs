//! The history of the supply voltage, and the rules that depend on it.

use crate::event::{MS, Time};
use crate::observer::Observer;
use crate::rule::Rule;

/// Time for which the supply must be low before the robot may react: six frames, minus up to one frame before the first
/// reading and up to one after the last.
const MIN_LOW_TIME: Time = 80 * MS;

/// Longest time from the end of a low supply to the report of a better level.
const MAX_RECOVERY_TIME: Time = 1_200 * MS;

/// Time within which the robot must detect a low supply: six frames and two readings.
const MAX_LOW_DETECTION_TIME: Time = 220 * MS;

/// Time from the firmware's start to the first reading, which is in the second frame.
const FIRST_READING_TIME: Time = 20 * MS;

/// The history of the supply voltage over the last two seconds.
#[derive(Clone, Debug, Default)]
pub(crate) struct SupplyHistory {
    /// The voltages in mV, each with the time at which it began.
    voltages: Vec<(Time, u32)>,
    /// The time of the last change to or from a voltage below the good range; `None` if there was no such change.
    last_change_below_good: Option<Time>,
}

impl SupplyHistory {
    pub(crate) fn record(&mut self, time: Time, mv: u32, min_good_mv: u32) {
        if self.current_mv() < min_good_mv || mv < min_good_mv {
            self.last_change_below_good = Some(time);
        }
        let is_old = |pair: &[(Time, u32)]| pair[1].0 < time - 2_000 * MS;
        let old_spans = self.voltages.windows(2).take_while(|pair| is_old(pair));
        let old_count = old_spans.count();
        self.voltages.drain(..old_count);
        self.voltages.push((time, mv));
    }

    fn current_mv(&self) -> u32 {
        self.voltages.last().map_or(u32::MAX, |(_, mv)| *mv)
    }

    /// True if the supply has been at or above `min_good_mv` since a time.
    pub(crate) fn has_been_good_since(&self, since: Time, min_good_mv: u32) -> bool {
        self.current_mv() >= min_good_mv
            && self.last_change_below_good.is_none_or(|time| time <= since)
    }

    /// Returns the total time in `from..to` during which the supply was below `mv`.
    pub(crate) fn time_below(&self, mv: u32, from: Time, to: Time) -> Time {
        let ends = self.voltages.iter().skip(1).map(|(time, _)| *time);
        let spans = self.voltages.iter().zip(ends.chain([Time::MAX]));
        let low_spans = spans.filter(|((_, span_mv), _)| *span_mv < mv);
        let low_times = low_spans.map(|((start, _), end)| end.min(to) - (*start).max(from));
        low_times.map(|time| time.max(0)).sum()
    }

    /// True if the supply has been below `mv` since a time.
    pub(crate) fn has_been_low_since(&self, mv: u32, since: Time) -> bool {
        let is_above = |(_, span_mv): &(Time, u32)| *span_mv >= mv;
        let last_above = self.voltages.iter().rposition(is_above);
        let first_low = self.voltages.get(last_above.map_or(0, |index| index + 1));
        first_low.is_some_and(|(start, _)| *start <= since)
    }

    /// Returns, for each level, the time since the supply last crossed it: plus 1 if the supply is now below the level,
    /// otherwise negated.
    pub(crate) fn signed_times_since_crossing(&self, levels_mv: [u32; 3], now: Time) -> [Time; 3] {
        levels_mv.map(|mv| {
            let is_low = self.current_mv() < mv;
            let is_same_side = |(_, span_mv): &&(Time, u32)| (*span_mv < mv) == is_low;
            let crossing = self.voltages.iter().rev().take_while(is_same_side).last();
            let age = crossing.map_or(0, |(time, _)| now - time);
            if is_low { age + 1 } else { -age }
        })
    }
}

impl Observer {
    /// Checks a report on the console that a low supply has made the robot stop or rest.
    pub(crate) fn check_supply_report(&mut self, report: &str) {
        let [_, stop_mv, rest_mv] = self.limits.levels_mv;
        let level_mv = match () {
            () if report.ends_with("pulses off") => rest_mv,
            () if report.ends_with("stopped") => stop_mv,
            () => return,
        };
        let (from, level_mv) = (self.now - 500 * MS, level_mv + self.limits.supply_error_mv);
        let low_time = self.supply.time_below(level_mv, from, self.now);
        // When a supply that was too low for pulses recovers, the hysteresis still forbids motions.
        let resting_time = match report.ends_with("stopped") {
            true => {
                let recovery_start = self.now - MAX_RECOVERY_TIME;
                let rest_mv = rest_mv + self.limits.supply_error_mv;
                self.supply.time_below(rest_mv, recovery_start, self.now)
            }
            false => 0,
        };
        if low_time.max(resting_time) < MIN_LOW_TIME {
            let ms = low_time / MS;
            let observation = format!("{report:?}, but the supply was low for only {ms} ms");
            self.record_violation(Rule::LowForSixFrames, observation);
        }
    }

    /// Checks a byte write to the EEPROM.
    pub(crate) fn check_eeprom_write(&mut self) {
        let now = self.now;
        if now - self.started_at < FIRST_READING_TIME {
            let us = (now - self.started_at) / 16;
            let observation = format!("a byte is written {us} us after the start");
            self.record_violation(Rule::SafeWrites, observation);
        }
        let slow_mv = self.limits.levels_mv[0].saturating_sub(self.limits.supply_error_mv);
        // The main loop takes no readings while it is stalled.
        let since = now - MAX_LOW_DETECTION_TIME - self.stalled_time_before(now);
        if self.supply.has_been_low_since(slow_mv, since) {
            let observation = "a byte is written while the supply is too low";
            self.record_violation(Rule::SafeWrites, observation);
        }
        let no_writes_until = self.pending_promises.no_writes_until;
        if no_writes_until.is_some_and(|until| now < until) {
            self.record_violation(Rule::SecondRestWritesNothing, "a byte is written");
        }
    }
}
