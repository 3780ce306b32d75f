//! The history of the supply's voltage, and the rules that depend on it.

use crate::event::{MS, NEVER, Time};
use crate::observer::Observer;
use crate::rule::Rule;

/// Margin above the first level (writing) from which the supply counts as good, mV.
pub(crate) const GOOD_ABOVE: u32 = 200;

/// Time for which the supply must be low before the robot may report it: six frames, less one frame before
/// the first reading and one after the last reading.
const SIX_FRAMES: Time = 80 * MS;

/// Time within which the robot must detect a low supply: six frames and two readings.
const LOW_DETECTION_TIME: Time = 220 * MS;

/// Time of the first reading after a start: in the second frame.
const FIRST_READING: Time = 20 * MS;

/// The supply's history over two seconds.
#[derive(Clone, Debug)]
pub(crate) struct Supply {
    /// Each voltage, mV, with the time from which it applied.
    history: Vec<(Time, u32)>,
    /// The time of the last change of the supply from or to a voltage that is not good.
    pub poor: Time,
}

impl Default for Supply {
    fn default() -> Self {
        Self {
            history: Vec::new(),
            poor: NEVER,
        }
    }
}

impl Supply {
    pub(crate) fn set(&mut self, time: Time, mv: u32, poor_below_mv: u32) {
        if self.voltage_now() < poor_below_mv || mv < poor_below_mv {
            self.poor = time;
        }
        let is_old = |pair: &[(Time, u32)]| pair[1].0 < time - 2_000 * MS;
        let old_count = self.history.windows(2).take_while(|pair| is_old(pair));
        let old_count = old_count.count();
        self.history.drain(..old_count);
        self.history.push((time, mv));
    }

    fn voltage_now(&self) -> u32 {
        self.history.last().map_or(u32::MAX, |(_, mv)| *mv)
    }

    /// True if the supply has been at or above `poor_below_mv`, mV, since this time.
    pub(crate) fn is_good_since(&self, since: Time, poor_below_mv: u32) -> bool {
        self.voltage_now() >= poor_below_mv && self.poor <= since
    }

    /// The total time within `from..to` for which the supply was below `mv`.
    pub(crate) fn time_below(&self, mv: u32, from: Time, to: Time) -> Time {
        let ends = self.history.iter().skip(1).map(|(time, _)| *time);
        let pieces = self.history.iter().zip(ends.chain([Time::MAX]));
        let low_pieces = pieces.filter(|((_, value_mv), _)| *value_mv < mv);
        low_pieces
            .map(|((start, _), until)| (until.min(to) - (*start).max(from)).max(0))
            .sum()
    }

    /// True if the supply has been below `mv` since this time.
    pub(crate) fn is_low_since(&self, mv: u32, since: Time) -> bool {
        let last_above = self
            .history
            .iter()
            .rposition(|(_, value_mv)| *value_mv >= mv);
        let first_low = self.history.get(last_above.map_or(0, |last| last + 1));
        first_low.is_some_and(|(start, _)| *start <= since)
    }

    /// The time since the supply last crossed each level: positive while the supply is below the level, zero or
    /// negative while it is not.
    pub(crate) fn times_since_crossed(&self, levels: [u32; 3], now: Time) -> [Time; 3] {
        levels.map(|mv| {
            let is_low = self.voltage_now() < mv;
            let is_same_side = |(_, value_mv): &&(Time, u32)| (*value_mv < mv) == is_low;
            let crossing = self.history.iter().rev().take_while(is_same_side).last();
            let age = crossing.map_or(0, |(time, _)| now - time);
            if is_low { age + 1 } else { -age }
        })
    }
}

impl Observer {
    /// Judges a console line that says that the supply stops or rests the robot.
    pub(crate) fn judge_supply_line(&mut self, text: &str) {
        let [_, stop_mv, rest_mv] = self.limits.levels;
        let level_mv = match () {
            () if text.ends_with("pulses ended") => rest_mv,
            () if text.ends_with("stopped") => stop_mv,
            () => return,
        };
        let (from, level_mv) = (self.now - 500 * MS, level_mv + self.limits.supply_error_mv);
        let low_time = self.supply.time_below(level_mv, from, self.now);
        if low_time < SIX_FRAMES {
            let ms = low_time / MS;
            self.fail(Rule::Supply, format!("{text:?}, below for {ms} ms"));
        }
    }

    /// Judges the write of a byte of the EEPROM.
    pub(crate) fn judge_write(&mut self) {
        let now = self.now;
        if now - self.start < FIRST_READING {
            let us = (now - self.start) / 16;
            self.fail(Rule::Written, format!("a byte {us} us after a start"));
        }
        let slow_mv = self.limits.levels[0].saturating_sub(self.limits.supply_error_mv);
        // While main is stalled it takes no readings.
        if self
            .supply
            .is_low_since(slow_mv, now - LOW_DETECTION_TIME - self.stalled(now))
        {
            self.fail(Rule::Written, "a byte, the supply too low");
        }
        if self.pending.unwritten.is_some_and(|until| now < until) {
            self.fail(Rule::RestAgain, "a byte is written");
        }
    }
}
