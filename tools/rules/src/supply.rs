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
const KNOWN_LOW: Time = 220 * MS;

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
    pub(crate) fn set(&mut self, time: Time, mv: u32, poor: u32) {
        if self.now() < poor || mv < poor {
            self.poor = time;
        }
        let is_old = |pair: &[(Time, u32)]| pair[1].0 < time - 2_000 * MS;
        let old = self.history.windows(2).take_while(|pair| is_old(pair));
        let old = old.count();
        self.history.drain(..old);
        self.history.push((time, mv));
    }

    fn now(&self) -> u32 {
        self.history.last().map_or(u32::MAX, |(_, mv)| *mv)
    }

    /// True if the supply has been at or above `poor`, mV, since this time.
    pub(crate) fn is_good_since(&self, since: Time, poor: u32) -> bool {
        self.now() >= poor && self.poor <= since
    }

    /// The total time within `from..to` for which the supply was below `mv`.
    pub(crate) fn time_below(&self, mv: u32, from: Time, to: Time) -> Time {
        let ends = self.history.iter().skip(1).map(|(at, _)| *at);
        let pieces = self.history.iter().zip(ends.chain([Time::MAX]));
        let low = pieces.filter(|((_, volts), _)| *volts < mv);
        low.map(|((at, _), until)| (until.min(to) - (*at).max(from)).max(0))
            .sum()
    }

    /// True if the supply has been below `mv` since this time.
    pub(crate) fn is_low_since(&self, mv: u32, since: Time) -> bool {
        let last_above = self.history.iter().rposition(|(_, volts)| *volts >= mv);
        let low = self.history.get(last_above.map_or(0, |last| last + 1));
        low.is_some_and(|(at, _)| *at <= since)
    }

    /// The time since the supply last crossed each level: positive while the supply is below the level, zero or
    /// negative while it is not.
    pub(crate) fn times_since_crossed(&self, levels: [u32; 3], now: Time) -> [Time; 3] {
        levels.map(|mv| {
            let is_low = self.now() < mv;
            let same = |(_, volts): &&(Time, u32)| (*volts < mv) == is_low;
            let since = self.history.iter().rev().take_while(same).last();
            let age = since.map_or(0, |(at, _)| now - at);
            if is_low { age + 1 } else { -age }
        })
    }
}

impl Observer {
    /// Judges a console line that says that the supply stops or rests the robot.
    pub(crate) fn judge_supply_line(&mut self, text: &str) {
        let [_, stop, rest] = self.limits.levels;
        let level = match () {
            () if text.ends_with("pulses ended") => rest,
            () if text.ends_with("stopped") => stop,
            () => return,
        };
        let (from, level) = (self.now - 500 * MS, level + self.limits.supply_error_mv);
        let low = self.supply.time_below(level, from, self.now);
        if low < SIX_FRAMES {
            let ms = low / MS;
            self.fail(Rule::Supply, format!("{text:?}, below for {ms} ms"));
        }
    }

    /// Judges the write of a byte of the EEPROM.
    pub(crate) fn judge_write(&mut self) {
        let at = self.now;
        if at - self.start < FIRST_READING {
            let us = (at - self.start) / 16;
            self.fail(Rule::Written, format!("a byte {us} us after a start"));
        }
        let slow = self.limits.levels[0].saturating_sub(self.limits.supply_error_mv);
        // While main is stalled it takes no readings.
        if self
            .supply
            .is_low_since(slow, at - KNOWN_LOW - self.stalled(at))
        {
            self.fail(Rule::Written, "a byte, the supply too low");
        }
        if self.pending.unwritten.is_some_and(|until| at < until) {
            self.fail(Rule::RestAgain, "a byte is written");
        }
    }
}
