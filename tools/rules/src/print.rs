//! The observer's state, rounded so that equivalent states are equal: the model checker then visits
//! them only once.

use std::fmt;

use crate::event::{MS, Time};
use crate::observer::Observer;

/// Sorts an age, in frames of 20 ms, into a few classes; returns the class's least number of frames.
pub const fn frames_class(age: Time) -> u8 {
    match age / (20 * MS) {
        ..=0 => 0,
        1..=3 => 1,
        4..=14 => 4,
        15..=70 => 15,
        _ => 71,
    }
}

impl Observer {
    /// A value whose `Debug` output is the same for equivalent states.
    pub fn coarse(&self) -> impl fmt::Debug + use<> {
        let age_class = |time: Time| frames_class(self.now.saturating_sub(time));
        let signed_class = |age: i64| {
            if age > 0 {
                i16::from(frames_class(age))
            } else {
                -i16::from(frames_class(-age)) - 1
            }
        };
        let servos = self.servos.map(|servo| {
            let is_on = self.now - servo.at < 30 * MS;
            (
                servo.width >> 11,
                is_on,
                servo.since,
                servo.is_hung,
                servo.is_lost,
            )
        });
        let last_pulse = self.servos.iter().map(|servo| servo.at).max();
        let silence_class = last_pulse.map(age_class);
        let frames_since_line = if self.deadman > 0 {
            (self.now - self.last_line) / (20 * MS)
        } else {
            0
        };
        let is_recent = |time: Time, ms: Time| self.now - time < ms * MS;
        let brown_outs = self
            .brown_outs
            .iter()
            .filter(|time| is_recent(**time, 4_000) && **time > self.ordered);
        (
            (
                servos,
                silence_class,
                (frames_since_line, self.is_driven),
                self.deadman,
                self.lines,
            ),
            (
                self.permission.may,
                self.permission.ends(),
                self.permission.boot.is_some(),
            ),
            (
                is_recent(self.start, 500),
                is_recent(self.ordered, 45),
                is_recent(self.disturbed, 300),
            ),
            self.supply
                .times_since_crossed(self.limits.levels, self.now)
                .map(signed_class),
            (
                self.reports.stopped.map(age_class),
                self.reports.is_reported,
                is_recent(self.reports.reported_at, 400),
            ),
            (brown_outs.count(), self.cause),
        )
    }
}
