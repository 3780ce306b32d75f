//! Rules for the reports of a stop, in `status` and on the console.

use lizard_core::console::word::{Effect, Word};
use lizard_core::memory::restart::Cause;
use lizard_core::virtual_board::is_answer;

use crate::answers::{CALM_TIME, MAX_TIME_TO_PULSE};
use crate::event::{MS, Time};
use crate::observer::Observer;
use crate::rule::Rule;

/// The longest time by which the report of a fault may precede the stop that it reports.
const MAX_REPORT_LEAD: Time = 400 * MS;

/// Time for which the supply must be low before `status` must name a fault.
const MAX_LOW_TIME_WITHOUT_FAULT: Time = 340 * MS;

/// The last stop by a fault, and its report on the console.
#[derive(Clone, Debug, Default)]
pub(crate) struct StopReport {
    /// The time at which a fault stopped the robot; `None` if no fault has occurred since the last motion command.
    pub stopped_at: Option<Time>,
    /// True if the console has reported the cause of the stop.
    pub is_reported: bool,
    /// True if a command after the report may not have reached the robot. A robot that is still stopped does not report
    /// the stop again.
    may_still_be_stopped: bool,
    /// The time of the last report of a fault on the console; `None` if there was no report.
    pub reported_at: Option<Time>,
}

impl StopReport {
    /// Records that a fault stops the robot, unless the robot is already stopped.
    pub(crate) fn record_stop(&mut self, time: Time) {
        if self.stopped_at.is_none() {
            self.stopped_at = Some(time);
            let is_recent = |reported_at| time - reported_at < MAX_REPORT_LEAD;
            self.is_reported = self.may_still_be_stopped || self.reported_at.is_some_and(is_recent);
        }
    }

    /// Records a start of the chip. A watchdog reset counts as a stop.
    pub(crate) fn record_start(&mut self, cause: Cause, time: Time) {
        *self = Self::default();
        if cause == Cause::Watchdog {
            self.stopped_at = Some(time);
        }
    }

    /// Records a motion command, which ends a stop. `is_certain` is false if the command may have been lost.
    pub(crate) const fn record_motion_command(&mut self, is_certain: bool) {
        let was_reported = self.stopped_at.is_some() && self.is_reported;
        self.may_still_be_stopped = !is_certain && (was_reported || self.may_still_be_stopped);
        self.stopped_at = None;
    }
}

impl Observer {
    /// Checks a line that the robot has printed. `first_byte_at` is the time at which its first byte was written.
    pub(crate) fn check_printed_line(&mut self, first_byte_at: Time, line: &str) {
        // If a reset cuts a line off, the banner follows in the same line. Such a line is no answer and no report.
        let is_complete = !line.contains("# lizard ");
        if is_answer(line) && is_complete {
            self.unanswered_line_count -= 1;
            if self.unanswered_line_count < 0 {
                self.record_violation(Rule::OneAnswer, format!("unsolicited answer: {line}"));
            }
        }
        if self.unanswered_line_count > 0 {
            // The robot may have read the next command only now, after this line.
            self.last_command_read_at = self.now;
        }
        self.record_accepted_command(line);
        if is_complete && (line.starts_with("# fault: ") || line.starts_with("# held")) {
            self.stop_report.is_reported = true;
            self.stop_report.reported_at = Some(self.now);
            if line.contains("no command within") {
                // Soon after a command, the line may report a stop that the command has already ended.
                if first_byte_at - self.last_motion_command_at >= self.limits.max_queue_time {
                    self.stop_report.record_stop(self.now);
                }
                let silence = first_byte_at - self.last_command_at;
                // If main was late, the command may have arrived after the stop, but before the report.
                if !self.was_command_delayed
                    && (self.limits.max_queue_time..self.deadman_time).contains(&silence)
                {
                    let (silence_ms, deadman_ms) = (silence / MS, self.deadman_time / MS);
                    let observation =
                        format!("deadman {deadman_ms}, but stopped after {silence_ms} ms");
                    self.record_violation(Rule::DeadmanNotEarly, observation);
                }
            }
        }
        if line == "# done" {
            self.unfinished_motion_count -= 1;
            if self.unfinished_motion_count < 0 {
                self.record_violation(Rule::DoneOncePerMotion, "one `# done` too many");
            }
        }
        if let Some(report) = line.strip_prefix("# supply: ") {
            self.check_supply_report(report);
        }
        if let Some(boot_action) = line.strip_prefix("# boot: ") {
            // A fault just after `boot` is reported before `boot`.
            let is_earlier = |time| self.now - time > self.limits.max_report_time;
            if self.stop_report.reported_at.is_some_and(is_earlier) {
                self.record_violation(Rule::NoBootAfterStop, line);
            }
            if boot_action == "rest" {
                self.boot_rest_at = self.now;
            }
            self.unfinished_motion_count += 1;
            self.permission.record_boot(self.now, boot_action);
        }
        let reports_rest = line.ends_with("pulses off") || line.contains("several times in a row");
        // If a command arrived while the line waited or was printed, the line no longer describes the robot.
        if reports_rest && first_byte_at - self.last_motion_command_at > self.limits.max_queue_time
        {
            self.permission.schedule_expiry(self.now);
        }
    }

    /// Updates `deadman_time` and `is_gait_or_routine` from an answer. A refusal changes nothing.
    pub(crate) fn record_accepted_command(&mut self, answer: &str) {
        let Some(accepted) = answer.strip_prefix("ok ") else {
            return;
        };
        let (word, arguments) = accepted.split_once(' ').unwrap_or((accepted, ""));
        match Word::find(word.as_bytes()) {
            Some(Word::Deadman) => self.deadman_time = arguments.parse().unwrap_or(0) * MS,
            // The saved `deadman` time may differ, so the observer stops checking it.
            Some(Word::Load | Word::Factory) => self.deadman_time = 0,
            _ => {}
        }
        match Word::find(word.as_bytes()).map(Word::effect) {
            // `ok gait=...` answers `status`. Any other word that is not a command is the name of a gait or a routine.
            None if !word.starts_with("gait=") => self.is_gait_or_routine = word != "stand",
            Some(Effect::Motion | Effect::CalibrationChange) => self.is_gait_or_routine = false,
            _ => {}
        }
    }

    /// Checks that the console has reported a stop by now. Call this only while a host reads the console.
    pub fn check_stop_is_reported(&mut self) {
        let is_due = |time| self.now - time > self.limits.max_report_time;
        if self.stop_report.stopped_at.is_some_and(is_due) && !self.stop_report.is_reported {
            self.record_violation(Rule::StopReported, "no report on the console");
        }
    }

    /// Checks an answer to `status`.
    pub(crate) fn check_status(&mut self, answer: &str) {
        let now = self.now;
        let status_value = |key: &str| {
            let mut pairs = answer.split(' ').filter_map(|pair| pair.split_once('='));
            pairs.find(|(name, _)| *name == key).map(|(_, value)| value)
        };
        let (gait, fault) = (status_value("gait"), status_value("fault"));
        let has_fault = fault != Some("none");
        if !has_fault && status_value("guard") == Some("held") {
            self.record_violation(Rule::GuardFaultNamed, answer);
        }
        let max_report_time = self.limits.max_report_time;
        let is_due = |since| now - since > max_report_time;
        if !has_fault && self.stop_report.stopped_at.is_some_and(is_due) {
            self.record_violation(Rule::StopReported, answer);
        }
        let is_watchdog_report_due = self.start_cause == Cause::Watchdog && is_due(self.started_at);
        if is_watchdog_report_due && status_value("reset") != Some("watchdog") {
            self.record_violation(Rule::StopReported, answer);
        }
        let stop_mv = self.limits.levels_mv[1].saturating_sub(self.limits.supply_error_mv);
        let low_since = now - MAX_LOW_TIME_WITHOUT_FAULT;
        if !has_fault
            && low_since > self.started_at
            && self.supply.has_been_low_since(stop_mv, low_since)
        {
            self.record_violation(Rule::StopReported, format!("the supply is low: {answer}"));
        }
        self.check_stop_is_reported();
        if has_fault && self.stop_report.stopped_at.is_none() {
            self.stop_report.stopped_at = Some(now);
            self.stop_report.is_reported = self.stop_report.reported_at.is_some();
        }
        if gait == Some("rest") {
            self.forbid_pulses(Rule::NoPulsesInRest);
        } else if !has_fault
            && self.last_motion_command_at < now - CALM_TIME
            && !self.was_disturbed_since(now - CALM_TIME)
        {
            let mut servos = self.servos.iter();
            let has_no_pulses = servos.all(|servo| servo.last_start < now - MAX_TIME_TO_PULSE);
            self.pending_promises.pulses_after_status =
                has_no_pulses.then(|| (now + MAX_TIME_TO_PULSE, answer.to_owned()));
        }
    }
}
