//! Rules for the robot's answers, and for the promises that the answers make.

use lizard_core::console::word::Effect;

use crate::event::{MS, Time};
use crate::observer::Observer;
use crate::rule::Rule;

/// Longest time from the answer to a motion command until all four servos have pulses.
const MAX_WAKE_TIME: Time = 600 * MS;

/// Time after an answer that promises no pulses, during which no pulse may begin.
const NO_PULSES_TIME: Time = 140 * MS;

/// Time after a repeated `rest` during which no byte of the EEPROM may be written.
const NO_WRITES_TIME: Time = 500 * MS;

/// Longest time from `rest` until the complete record of the rest pose is in the EEPROM.
const MAX_SAVE_TIME: Time = 400 * MS;

/// Time before or after an answer to `status` without a fault in which a servo must get a pulse.
pub(crate) const MAX_TIME_TO_PULSE: Time = 200 * MS;

/// Time before such an answer for which the robot must have been undisturbed; otherwise the answer promises nothing.
pub(crate) const CALM_TIME: Time = 400 * MS;

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
                let is_supply_good = self.has_supply_been_good_since(self.first_rest_at);
                let has_rested = self.first_rest_at > self.started_at;
                let is_pose_saved = has_rested && sent_at > self.first_rest_at + MAX_SAVE_TIME;
                if is_pose_saved && is_supply_good && self.limits.is_memory_reliable {
                    self.pending_promises.no_writes_until = Some(sent_at + NO_WRITES_TIME);
                } else if self.first_rest_at < self.started_at {
                    // This is the first `rest` since the start or since another command.
                    self.first_rest_at = sent_at;
                }
            }
            _ => {}
        }
    }

    /// Forbids pulses from the end of the frame until [`NO_PULSES_TIME`] from now.
    pub(crate) fn forbid_pulses(&mut self, rule: Rule) {
        let from = self.now + self.limits.max_frame_remainder;
        self.pending_promises.no_pulses = Some((from, self.now + NO_PULSES_TIME, rule));
    }

    fn has_supply_been_good_since(&self, time: Time) -> bool {
        let min_good_mv = self.limits.min_good_mv();
        self.supply.has_been_good_since(time, min_good_mv)
    }

    /// Checks the promises that are due.
    pub(crate) fn check_due_promises(&mut self) {
        if let Some((from, until, pulsed_servos)) = self.pending_promises.motion
            && self.now > until
        {
            self.pending_promises.motion = None;
            if let Some(servo) = pulsed_servos.iter().position(|has_pulse| !has_pulse)
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
            && !self.was_disturbed_since(until - MAX_TIME_TO_PULSE - CALM_TIME)
        {
            self.record_violation(Rule::StatusNamesCause, answer);
        }
    }

    /// Checks the promises about pulses at the start of a pulse.
    pub(crate) fn check_pulse_promises(&mut self, servo: usize) {
        let now = self.now;
        if let Some((_, _, pulsed_servos)) = &mut self.pending_promises.motion {
            pulsed_servos[servo] = true;
        }
        self.pending_promises.pulses_after_status = None;
        if let Some((from, until, rule)) = self.pending_promises.no_pulses
            && (from..until).contains(&now)
            && (rule == Rule::RestEndsPulses
                || !self.was_disturbed_since(from - self.limits.max_frame_remainder))
        {
            let ms = (now - from + self.limits.max_frame_remainder) / MS;
            let observation = format!("A{} has a pulse {ms} ms after the answer", servo + 1);
            self.record_violation(rule, observation);
            self.pending_promises.no_pulses = None;
        }
    }

    /// True if the robot must have saved a servo's rest pose by now: since the servo's last complete pulse, the supply
    /// has been good and the main loop undisturbed for long enough, and no settings are unsaved. After a restart, the
    /// servo must then wake in this pose.
    pub(crate) fn must_rest_pose_be_saved(&self, servo: usize) -> bool {
        let pulse_start = self.servos[servo].last_complete_pulse_start;
        self.limits.is_memory_reliable
            && self.now - pulse_start > MAX_SAVE_TIME
            && self.has_supply_been_good_since(pulse_start)
            && self.disturbed_until <= pulse_start
            && !self.has_unsaved_settings
    }
}
