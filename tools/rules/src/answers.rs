//! Rules for the robot's answers, and for the promises that the answers make.

use lizard_core::console::word::Effect;

use crate::event::{MS, Time};
use crate::observer::Observer;
use crate::rule::Rule;

/// Longest time from the answer to a motion command until all four servos have pulses.
const MAX_WAKE_TIME: Time = 600 * MS;

/// Time during which no pulse may begin after an answer that promises no pulses.
const NO_PULSES_TIME: Time = 140 * MS;

/// Longest time from `rest` until the complete record of the rest pose is in the EEPROM.
const MAX_SAVE_TIME: Time = 400 * MS;

/// Lines that every robot must refuse.
const INVALID_LINES: [&str; 7] = [
    "walk 0",
    "nonsense",
    "trim 1 90",
    "speed 5",
    "limit 2 1 2",
    "boot walk 1",
    "pose 0 0 0 0",
];

impl Observer {
    /// Checks the answer to a line that was sent at `sent_at`, and records the answer's promises.
    pub(crate) fn check_answer(&mut self, line: &str, effect: Effect, sent_at: Time, answer: &str) {
        let now = self.now;
        if answer.starts_with("ok gait=") {
            return self.check_status(answer);
        }
        if !answer.starts_with("ok") {
            return;
        }
        if INVALID_LINES.contains(&line) {
            self.record_violation(Rule::InvalidRefused, format!("answer to {line}: {answer}"));
        }
        self.record_accepted_command(answer);
        match effect {
            Effect::Motion if !self.was_disturbed_since(now) => {
                self.pending_promises.motion = Some((now, now + MAX_WAKE_TIME, [false; 4]));
            }
            Effect::Rest => {
                if self.disturbed_until <= sent_at {
                    self.forbid_pulses(Rule::RestEndsPulses);
                }
                let is_good = self.has_supply_been_good_since(self.first_rest_at);
                let is_repeated = self.first_rest_at > self.started_at
                    && sent_at > self.first_rest_at + MAX_SAVE_TIME;
                if is_repeated && is_good && self.limits.is_memory_reliable {
                    self.pending_promises.no_writes_until = Some(sent_at + 500 * MS);
                } else if self.first_rest_at < self.started_at {
                    self.first_rest_at = sent_at;
                }
            }
            _ => {}
        }
    }

    /// Forbids pulses from the end of the frame on.
    pub(crate) fn forbid_pulses(&mut self, rule: Rule) {
        let from = self.now + self.limits.max_frame_remainder;
        self.pending_promises.no_pulses = Some((from, self.now + NO_PULSES_TIME, rule));
    }

    fn has_supply_been_good_since(&self, time: Time) -> bool {
        let min_good_mv = self.limits.min_good_mv();
        self.supply.has_been_good_since(time, min_good_mv)
    }

    /// Checks the promises whose time has ended.
    pub(crate) fn check_expired_promises(&mut self) {
        if let Some((from, until, has_pulses)) = self.pending_promises.motion
            && self.now > until
        {
            self.pending_promises.motion = None;
            if let Some(servo) = has_pulses.iter().position(|has_pulse| !has_pulse)
                && !self.was_disturbed_since(from)
            {
                let observation = format!("A{} has no pulses", servo + 1);
                self.record_violation(Rule::MotionHasPulses, observation);
            }
        }
        let promises = &mut self.pending_promises;
        promises.no_writes_until.take_if(|until| self.now > *until);
        let is_due = |(until, _): &mut (Time, String)| self.now > *until;
        if let Some((until, answer)) = promises.pulses_after_status.take_if(is_due)
            && !self.was_disturbed_since(until - 600 * MS)
        {
            self.record_violation(Rule::StatusNamesCause, answer);
        }
    }

    /// Checks the promises about pulses at the start of a pulse.
    pub(crate) fn check_pulse_promises(&mut self, servo: usize) {
        let now = self.now;
        if let Some((_, _, has_pulses)) = &mut self.pending_promises.motion {
            has_pulses[servo] = true;
        }
        self.pending_promises.pulses_after_status = None;
        if let Some((from, until, rule)) = self.pending_promises.no_pulses
            && (from..until).contains(&now)
            && (rule == Rule::RestEndsPulses
                || !self.was_disturbed_since(from - self.limits.max_frame_remainder))
        {
            let ms = (now - from + self.limits.max_frame_remainder) / MS;
            self.record_violation(rule, format!("A{} has a pulse {ms} ms later", servo + 1));
            self.pending_promises.no_pulses = None;
        }
    }

    /// True if a servo must wake in its rest pose after a restart now: since its last complete pulse, the supply has
    /// been good, and main has been undisturbed for long enough to save the pose.
    pub(crate) fn must_keep_rest_pose(&self, servo: usize) -> bool {
        let pulse_start = self.servos[servo].last_complete_pulse_start;
        self.limits.is_memory_reliable
            && self.now - pulse_start > MAX_SAVE_TIME
            && self.has_supply_been_good_since(pulse_start)
            && self.disturbed_until <= pulse_start
            && !self.has_unsaved_settings
    }
}
