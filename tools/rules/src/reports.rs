//! The rules about reports of a stop: in `status` and on the console.

use lizard_core::console::word::{Effect, Word};
use lizard_core::memory::restart::Cause;
use lizard_core::virtual_board::is_answer;

use crate::event::{MS, NEVER, Time};
use crate::observer::Observer;
use crate::rule::Rule;

/// The last stop by a fault, and whether the console has reported it.
#[derive(Clone, Debug)]
pub(crate) struct Reports {
    /// Time at which a fault stopped the robot, until the user acts.
    pub stopped: Option<Time>,
    /// True once the console has reported the reason.
    pub is_reported: bool,
    /// True if, after the report, an order was sent that may not have reached the robot: a robot that
    /// is still stopped does not report the stop again.
    may_still_be_stopped: bool,
    /// Time of the last report of a fault on the console.
    pub reported_at: Time,
}

impl Default for Reports {
    fn default() -> Self {
        Self {
            stopped: None,
            is_reported: false,
            may_still_be_stopped: false,
            reported_at: NEVER,
        }
    }
}

impl Reports {
    /// Records that a fault stops the robot.
    pub(crate) fn stop(&mut self, time: Time) {
        if self.stopped.is_none() {
            self.stopped = Some(time);
            self.is_reported = self.may_still_be_stopped || time - self.reported_at < 400 * MS;
        }
    }

    pub(crate) fn start(&mut self, cause: Cause, time: Time) {
        *self = Self::default();
        if cause == Cause::Watchdog {
            self.stopped = Some(time);
        }
    }

    /// Ends a stop because of an order to move, which may have been lost unless `is_sure`.
    pub(crate) const fn order(&mut self, is_sure: bool) {
        let was_reported = self.stopped.is_some() && self.is_reported;
        self.may_still_be_stopped = !is_sure && (was_reported || self.may_still_be_stopped);
        self.stopped = None;
    }
}

impl Observer {
    /// Judges a line that the robot printed; `since` is the time at which the line's first byte was written.
    pub(crate) fn judge_line(&mut self, since: Time, line: &str) {
        // After a reset the banner follows on the line that the reset has cut off, which is then no answer.
        if is_answer(line) && !line.contains("# lizard ") {
            self.lines -= 1;
            if self.lines < 0 {
                self.fail(Rule::OneAnswer, format!("unasked: {line}"));
            }
            if self.lines > 0 {
                // The next command may have waited until this answer was written.
                self.command_read = self.now;
            }
        }
        self.note_done(line);
        if line.starts_with("# fault: ") || line.starts_with("# held") {
            self.reports.is_reported = true;
            self.reports.reported_at = self.now;
            if line.contains("no line for") {
                // A line printed just after an order may report a stop that the order has ended already.
                if since - self.ordered >= self.limits.queued {
                    self.reports.stop(self.now);
                }
                let silence = since - self.last_line;
                if (self.limits.queued..self.deadman).contains(&silence) {
                    let (silence_ms, deadman_ms) = (silence / MS, self.deadman / MS);
                    self.fail(
                        Rule::Deadman,
                        format!("deadman {deadman_ms}, after {silence_ms} ms"),
                    );
                }
            }
        }
        if line == "# done" {
            self.unfinished_motions -= 1;
            if self.unfinished_motions < 0 {
                self.fail(Rule::Done, "once too often");
            }
        }
        if let Some(text) = line.strip_prefix("# supply: ") {
            self.judge_supply_line(text);
        }
        if let Some(boot) = line.strip_prefix("# boot: ") {
            if boot == "rest" {
                self.booted_to_rest = self.now;
            }
            self.unfinished_motions += 1;
            self.permission.note_boot(self.now, boot);
        }
        let is_end = line.ends_with("pulses ended") || line.contains("several times in a row");
        // An order that came while the line waited or was being printed has overtaken it.
        if is_end && since - self.ordered > self.limits.queued {
            self.permission.end(self.now);
        }
    }

    /// Updates `deadman` and `is_driven` from the answer to a line; a refusal changes nothing.
    pub(crate) fn note_done(&mut self, answer: &str) {
        let Some(accepted) = answer.strip_prefix("ok ") else {
            return;
        };
        let (word, arguments) = accepted.split_once(' ').unwrap_or((accepted, ""));
        match Word::find(word.as_bytes()) {
            Some(Word::Deadman) => self.deadman = arguments.parse().unwrap_or(0) * MS,
            // Another `deadman` time may have been saved.
            Some(Word::Load | Word::Factory) => self.deadman = 0,
            _ => {}
        }
        match Word::find(word.as_bytes()).map(Word::effect) {
            // No word of the console, so the name of a gait or a routine.
            None if !word.starts_with("gait=") => self.is_driven = word != "stand",
            Some(Effect::Moves | Effect::Calibrates) => self.is_driven = false,
            _ => {}
        }
    }

    /// Checks that a stop has been reported on the console by now. Called only while somebody
    /// reads the console.
    pub fn check_reported(&mut self) {
        let stopped_at = self.reports.stopped;
        let is_due = |time| self.now - time > self.limits.report_time;
        if stopped_at.is_some_and(is_due) && !self.reports.is_reported {
            self.fail(Rule::Told, "nothing on the console");
        }
    }

    /// Judges an answer to `status`.
    pub(crate) fn status(&mut self, text: &str) {
        let now = self.now;
        let value_of = |key: &str| {
            let mut pairs = text.split(' ').filter_map(|pair| pair.split_once('='));
            pairs.find(|(name, _)| *name == key).map(|(_, value)| value)
        };
        let (gait, fault) = (value_of("gait"), value_of("fault"));
        let has_fault = fault != Some("none");
        if !has_fault && value_of("guard") == Some("held") {
            self.fail(Rule::GuardNamed, text);
        }
        let report_time = self.limits.report_time;
        let is_due = |since| now - since > report_time;
        if !has_fault && self.reports.stopped.is_some_and(is_due) {
            self.fail(Rule::Told, text);
        }
        let is_hung = self.cause == Cause::Watchdog && is_due(self.start);
        if is_hung && value_of("reset") != Some("watchdog") {
            self.fail(Rule::Told, text);
        }
        let stop_mv = self.limits.levels[1].saturating_sub(self.limits.supply_error_mv);
        let low_since = now - 340 * MS;
        if !has_fault && low_since > self.start && self.supply.is_low_since(stop_mv, low_since) {
            self.fail(Rule::Told, format!("the supply is low: {text}"));
        }
        self.check_reported();
        if has_fault && self.reports.stopped.is_none() {
            self.reports.stopped = Some(now);
            self.reports.is_reported = true;
        }
        if gait == Some("rest") {
            self.pending.quiet = Some((
                now + self.limits.frame_left,
                now + 140 * MS,
                Rule::RestIsRest,
            ));
        } else if !has_fault && self.ordered < now - 400 * MS && !self.is_troubled(now - 400 * MS) {
            let is_silent = self.servos.iter().all(|servo| servo.at < now - 200 * MS);
            self.pending.status = is_silent.then(|| (now + 200 * MS, text.to_owned()));
        }
    }
}
