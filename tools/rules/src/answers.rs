//! The robot's answers, and the promises that they make.

use lizard_core::console::word::Effect;

use crate::event::{MS, Time};
use crate::observer::Observer;
use crate::rule::Rule;

/// Longest time from the answer to an order until all four servos have pulses.
const UNTIL_AWAKE: Time = 600 * MS;

/// Time from an answer that promises no pulses to the end of the check that none begins.
const QUIET_TIME: Time = 140 * MS;

/// Longest time from `rest` until the complete record of the rest pose is in the EEPROM.
const SAVING_TIME: Time = 400 * MS;

/// Lines that no robot may accept.
const WRONG_LINES: [&str; 7] = [
    "walk 0",
    "nonsense",
    "trim 1 90",
    "speed 5",
    "limit 2 1 2",
    "boot walk 1",
    "pose 0 0 0 0",
];

impl Observer {
    /// Judges the answer to a line sent at `asked`, and records the promises in it.
    pub(crate) fn answer(&mut self, line: &str, effect: Effect, asked: Time, text: &str) {
        let now = self.now;
        if text.starts_with("ok gait=") {
            return self.status(text);
        }
        if !text.starts_with("ok") {
            return;
        }
        if WRONG_LINES.contains(&line) {
            self.fail(Rule::Wrong, format!("{line}: {text}"));
        }
        self.note_done(text);
        match effect {
            Effect::Moves if !self.is_troubled(now) => {
                self.pending.moves = Some((now, now + UNTIL_AWAKE, [false; 4]));
            }
            Effect::Rests => {
                if self.disturbed <= asked {
                    self.pending.quiet = Some((
                        now + self.limits.frame_left,
                        now + QUIET_TIME,
                        Rule::RestEnds,
                    ));
                }
                let least_good_mv = self.limits.levels[0] + crate::supply::GOOD_ABOVE;
                let is_good = self
                    .supply
                    .is_good_since(self.first_rest_command, least_good_mv);
                let is_repeated = self.first_rest_command > self.start
                    && asked > self.first_rest_command + SAVING_TIME;
                if is_repeated && is_good && self.limits.keeps_memory {
                    self.pending.unwritten = Some(asked + 500 * MS);
                } else if self.first_rest_command < self.start {
                    self.first_rest_command = asked;
                }
            }
            _ => {}
        }
    }

    /// Judges the promises that are due.
    pub(crate) fn check_pending(&mut self) {
        if let Some((from, until, has_pulses)) = self.pending.moves
            && self.now > until
        {
            self.pending.moves = None;
            let missing_servo = has_pulses.iter().position(|has_pulse| !has_pulse);
            if let Some(servo) = missing_servo
                && !self.is_troubled(from)
            {
                self.fail(Rule::Moves, format!("A{} has no pulses", servo + 1));
            }
        }
        if let Some((until, text)) = self.pending.status.take_if(|(until, _)| self.now > *until)
            && !self.is_troubled(until - 600 * MS)
        {
            self.fail(Rule::StatusSaysWhy, text);
        }
        self.pending.unwritten.take_if(|until| self.now > *until);
    }

    /// Judges the promises about pulses when a pulse begins.
    pub(crate) fn judge_expected_pulse(&mut self, servo: usize) {
        let now = self.now;
        if let Some((_, _, has_pulses)) = &mut self.pending.moves {
            has_pulses[servo] = true;
        }
        self.pending.status = None;
        if let Some((from, until, rule)) = self.pending.quiet
            && (from..until).contains(&now)
            && (rule == Rule::RestEnds || !self.is_troubled(from - self.limits.frame_left))
        {
            let ms = (now - from + self.limits.frame_left) / MS;
            self.fail(rule, format!("A{} has a pulse {ms} ms later", servo + 1));
            self.pending.quiet = None;
        }
    }

    /// True if a servo must wake in its rest pose after a restart at this moment: the supply was good and main
    /// undisturbed for long enough to save the pose of the last whole pulse.
    pub(crate) fn must_keep_rest_pose(&self, servo: usize) -> bool {
        let since = self.servos[servo].whole_at;
        let least_good_mv = self.limits.levels[0] + crate::supply::GOOD_ABOVE;
        self.limits.keeps_memory
            && self.now - since > SAVING_TIME
            && self.supply.is_good_since(since, least_good_mv)
            && self.disturbed <= since
            && !self.is_unsaved
    }
}
