//! The dialogue with the robot: the next line to send, the lines to show, and the events to record.
//!
//! The robot answers each line once and in order, and prints other lines in between. For the screen's status line, the
//! console sends `status` twice a second. While a person drives, it sends `status` more often, even if an answer is
//! outstanding. The answers are not shown. `stop` does not wait: it is sent at once and repeated until the robot
//! answers, because a link may lose a line or its answer. Failed lines are counted for the exit code of a script.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use super::deadman::{self, Deadman, DeadmanLine};
use super::link::BANNER_START;
use super::recorder::Event;
use crate::Failure;
use lizard_robot::Status;

use answer::{can_answer, is_stop_refusal};
use request::{Request, UnansweredStop};

pub(super) mod answer;
mod request;
mod reset;

/// Interval between two `status` lines while no person drives the robot.
const STATUS_INTERVAL: Duration = Duration::from_millis(500);
/// Longest wait for the answer to a line.
const ANSWER_TIMEOUT: Duration = Duration::from_millis(2000);
/// Longest wait for the answer to the program's own `status`.
const STATUS_TIMEOUT: Duration = Duration::from_millis(600);
/// Interval between two unanswered `stop` lines.
const STOP_INTERVAL: Duration = Duration::from_millis(250);
/// Time after a `stop` during which answers to earlier `stop` lines may arrive.
const LATE_ANSWER_TIME: Duration = Duration::from_millis(500);
/// Time without an answer to `stop` before the user is informed.
const SILENCE_TIMEOUT: Duration = Duration::from_millis(800);

/// The state of a dialogue with the robot.
#[derive(Debug)]
pub struct Session {
    /// The unanswered request, its line, and the end of the wait for its answer.
    pending_request: Option<(Request, String, Instant)>,
    /// The `stop` that is repeated until the robot answers.
    unanswered_stop: Option<UnansweredStop>,
    /// True from a missing answer to the program's own `status` or `watch` until the next answer, so that the user is
    /// informed only once.
    is_silent: bool,
    /// The time until which answers to repeated `stop` lines may arrive.
    late_answers_until: Instant,
    /// The lines that wait to be sent, the next one first.
    queue: VecDeque<Request>,
    /// The robot's `deadman` and its replacement; `None` unless a person drives.
    deadman: Option<Deadman>,
    /// True if the program requests the status repeatedly.
    polls_status: bool,
    /// The time at which the next `status` is due.
    next_status_time: Instant,
    /// True while the program requests poses with `watch`; false after a `watch` from the user.
    watches_poses: bool,
    /// True if `watch` is the next line to send.
    is_watch_due: bool,
    /// The robot's latest status.
    status: Option<Status>,
    /// The number of frames since the robot's reset in its latest status.
    frame_count: u64,
    /// The events since the last call of `take_events`.
    events: Vec<Event>,
    /// Number of the user's lines that were sent or failed, including each `stop`.
    user_line_count: usize,
    /// The user's lines that were refused, not answered or not sent, each with the reason.
    failures: Vec<(String, String)>,
}

impl Session {
    /// Starts a dialogue. Requests the status repeatedly if `polls_status` is true, and every pose if `watches_poses`
    /// is true.
    pub fn new(now: Instant, polls_status: bool, watches_poses: bool) -> Self {
        Self {
            pending_request: None,
            unanswered_stop: None,
            is_silent: false,
            late_answers_until: now,
            queue: VecDeque::new(),
            deadman: None,
            polls_status,
            next_status_time: now,
            watches_poses,
            is_watch_due: watches_poses,
            status: None,
            frame_count: 0,
            events: Vec::new(),
            user_line_count: 0,
            failures: Vec::new(),
        }
    }

    /// Makes the dialogue set `deadman` while the robot walks, because a person could drive it out of range.
    #[must_use]
    pub fn with_deadman(mut self) -> Self {
        self.deadman = Some(Deadman::default());
        self
    }

    /// Queues a user's line.
    pub fn queue(&mut self, line: &str) {
        let word = line.split_whitespace().next();
        if word.is_some_and(|word| word.eq_ignore_ascii_case("watch")) {
            self.watches_poses = false;
        }
        // The line may start a gait, so `deadman` stays set until the next status.
        self.queue
            .retain(|request| !matches!(request, Request::Deadman(DeadmanLine::Restore)));
        let deadman = self.deadman.as_mut();
        let planned_lines = deadman.map(|deadman| deadman.plan_lines(line));
        let (before, after) = planned_lines.unwrap_or_default();
        let to_request = |line: &DeadmanLine| Request::Deadman(*line);
        self.queue.extend(before.iter().map(to_request));
        self.queue.push_back(Request::Line(line.to_owned()));
        self.queue.extend(after.iter().map(to_request));
    }

    /// Returns the line that restores the robot's own `deadman` before the program ends, so that the robot continues
    /// its gait; `None` if `deadman` is not set. Also `None` if the robot has not answered `stop`: it may still walk,
    /// and then stops by itself.
    pub fn restore_deadman(&mut self) -> Option<String> {
        if self.is_stopping() {
            return None;
        }
        let is_restore_pending = matches!(
            self.pending_request,
            Some((Request::Deadman(DeadmanLine::Restore), ..))
        );
        if is_restore_pending && let Some(deadman) = &mut self.deadman {
            deadman.record_unconfirmed();
        }
        let deadman = self.deadman.as_mut();
        let overridden = deadman.filter(|deadman| deadman.is_overridden)?;
        overridden.apply_line(DeadmanLine::Restore)
    }

    /// Makes the next `status` due at once; queued lines still come first.
    pub fn request_status(&mut self, now: Instant) {
        self.next_status_time = now;
    }

    /// True while `deadman` is set because the robot walks or is about to walk.
    pub fn is_driven(&self) -> bool {
        self.deadman.as_ref().is_some_and(Deadman::is_driving)
    }

    /// True while a `stop` is unanswered.
    pub fn is_stopping(&self) -> bool {
        self.unanswered_stop.is_some()
    }

    /// Stops the robot. Queued lines are dropped, because they could start it again. Lines about `deadman` stay: an
    /// earlier line may have restored the robot's own setting for a dropped line.
    pub fn stop(&mut self, now: Instant) {
        self.queue.retain(|request| {
            matches!(request, Request::Deadman(line) if *line != DeadmanLine::RestoreForOneLine)
        });
        self.user_line_count += 1;
        self.events.push(Event::Sent("stop".to_owned()));
        self.unanswered_stop.get_or_insert(UnansweredStop::new(now));
    }

    /// Takes the line to send now; `None` if no line is due, or if an answer must come first.
    pub fn take_next_line(&mut self, now: Instant) -> Option<String> {
        if let Some(stop) = &mut self.unanswered_stop {
            if now < stop.next_send_time {
                return None;
            }
            stop.next_send_time = now + STOP_INTERVAL;
            stop.sent_count += 1;
            self.late_answers_until = now + LATE_ANSWER_TIME;
            return Some("stop".to_owned());
        }
        if self.pending_request.is_some() {
            return self.take_extra_status(now);
        }
        if now < self.late_answers_until {
            return None;
        }
        let request = if std::mem::take(&mut self.is_watch_due) {
            Request::Watch
        } else if let Some(request) = self.queue.pop_front() {
            request
        } else if self.polls_status && now >= self.next_status_time {
            let deadman = self.deadman.as_ref();
            let interval = match deadman.is_some_and(|deadman| deadman.is_overridden) {
                true => deadman::LINE_INTERVAL,
                false => STATUS_INTERVAL,
            };
            self.next_status_time = now + interval;
            Request::Status
        } else {
            return None;
        };
        let line = match &request {
            Request::Line(line) => {
                self.user_line_count += 1;
                self.events.push(Event::Sent(line.clone()));
                line.clone()
            }
            Request::Status => "status".to_owned(),
            Request::Watch => "watch 1".to_owned(),
            Request::Deadman(line) => self.deadman.as_mut()?.apply_line(*line)?,
        };
        let timeout = match request {
            Request::Status => STATUS_TIMEOUT,
            _ => ANSWER_TIMEOUT,
        };
        self.pending_request = Some((request, line.clone(), now + timeout));
        Some(line)
    }

    /// Takes an additional `status` while an answer is outstanding and `deadman` is set: the link may have lost the
    /// answer, and the robot would end its gait before the end of the wait.
    fn take_extra_status(&mut self, now: Instant) -> Option<String> {
        let overridden = self
            .deadman
            .as_ref()
            .filter(|deadman| deadman.is_overridden)?;
        if !self.polls_status || now < self.next_status_time {
            return None;
        }
        self.next_status_time = now + overridden.extra_line_interval();
        Some("status".to_owned())
    }

    /// Records that the robot has not confirmed a line about `deadman`; returns the message to the user.
    /// [`DeadmanLine::Restore`] is sent again after the next status in which the robot does not walk, and before a
    /// queued line that needs it. After any other line, drops the queued lines, because the robot would keep walking
    /// out of range.
    fn record_unconfirmed_deadman(&mut self, deadman_line: DeadmanLine) -> String {
        if let Some(deadman) = &mut self.deadman {
            deadman.record_unconfirmed();
        }
        let failure_count = self.failures.len();
        if deadman_line == DeadmanLine::Restore {
            self.plan_queue_again();
        } else {
            for request in std::mem::take(&mut self.queue) {
                if let Request::Line(line) = request {
                    self.user_line_count += 1;
                    self.record_failure(line, "not sent");
                }
            }
        }
        let start = match self.failures.len() > failure_count {
            true => "not sent: ",
            false => "",
        };
        format!("({start}the robot has not confirmed its `deadman` setting)")
    }

    /// Queues the line that restores the robot's own `deadman` if the robot neither walks nor is about to walk.
    fn end_driving(&mut self) {
        let (Some(deadman), Some(status)) = (&mut self.deadman, &self.status) else {
            return;
        };
        let is_resting = status.gait == "rest" && status.fault.is_none();
        deadman.is_gait_under_way = status.is_walking() || deadman.is_gait_under_way && is_resting;
        if deadman.is_overridden && !deadman.is_gait_under_way && self.queue.is_empty() {
            if deadman.is_unknown() {
                self.queue.push_back(Request::Deadman(DeadmanLine::Read));
            }
            self.queue.push_back(Request::Deadman(DeadmanLine::Restore));
        }
    }

    /// Handles a line from the robot; returns the text to show to the user, if any.
    pub fn receive(&mut self, line: &str) -> Option<String> {
        let visible_line = Some(line.to_owned());
        if let Some(deadman) = &mut self.deadman {
            deadman.is_gait_under_way &= !matches!(line, "# done" | "ok rest" | "ok stop");
        }
        let is_stop_refused = self.unanswered_stop.is_some() && is_stop_refusal(line);
        if (line == "ok stop" || is_stop_refused) && !self.is_stop_line_pending() {
            return self.receive_stop_answer(line);
        }
        if let (Some((Request::Deadman(_), ..)), Some(deadman)) =
            (&self.pending_request, &mut self.deadman)
            && deadman.parse_cal_line(line)
        {
            return None;
        }
        if line.starts_with('#') {
            self.events.push(Event::from_note(line));
            if line.starts_with(BANNER_START) {
                self.begin_after_reset();
                // The board was reset and will not answer the request.
                if let Some((Request::Line(sent_line), ..)) = self.pending_request.take() {
                    let message = format!("{line} (no answer to `{sent_line}`)");
                    self.record_failure(sent_line, "no answer");
                    return Some(message);
                }
            }
            return visible_line.filter(|_| !(self.watches_poses && line.starts_with("# t=")));
        }
        self.is_silent = false;
        let status = Status::parse(line);
        if let Some(status) = &status {
            self.receive_frame_count(status.frames);
        }
        self.status = status.clone().or(self.status.take());
        let is_answered = |(request, sent_line, _): &mut (Request, String, _)| match request {
            // A late answer may belong to an earlier line with the other value.
            Request::Deadman(_) => line
                .strip_prefix("ok ")
                .is_none_or(|rest| rest == sent_line),
            _ => can_answer(line, sent_line),
        };
        match self.pending_request.take_if(is_answered) {
            Some((Request::Status, ..)) if status.is_some() => {
                self.events.push(Event::Status(line.to_owned()));
                self.end_driving();
                return None;
            }
            Some((Request::Deadman(deadman_line), ..)) if line.starts_with("err ") => {
                let message = self.record_unconfirmed_deadman(deadman_line);
                return Some(format!("{line} {message}"));
            }
            Some((Request::Deadman(DeadmanLine::Read), ..))
                if self.deadman.as_ref().is_some_and(Deadman::is_unknown) =>
            {
                return Some(self.record_unconfirmed_deadman(DeadmanLine::Read));
            }
            Some((Request::Deadman(_) | Request::Watch, ..)) => return None,
            Some((Request::Line(sent_line), ..)) if line.starts_with("err ") => {
                self.record_failure(sent_line, line)
            }
            Some((Request::Line(sent_line), ..)) => {
                if let Some(deadman) = &mut self.deadman {
                    deadman.record_accepted_line(&sent_line);
                }
            }
            // The answer to an additional or a late `status` of the program.
            _ if self.polls_status && status.is_some() => {
                self.events.push(Event::Status(line.to_owned()));
                return None;
            }
            _ => {}
        }
        self.events.push(Event::Answer(line.to_owned()));
        visible_line
    }

    /// True if a `stop` that was sent as a normal line, for example from a script, is unanswered.
    fn is_stop_line_pending(&self) -> bool {
        let is_stop = |line: &str| line.eq_ignore_ascii_case("stop");
        matches!(&self.pending_request, Some((Request::Line(line), ..)) if is_stop(line))
    }

    /// Ends the repetition of `stop` after its answer; returns the line to show, or `None` if no `stop` is unanswered.
    fn receive_stop_answer(&mut self, line: &str) -> Option<String> {
        let stop = self.unanswered_stop.take()?;
        // The latest status is older than this answer.
        self.status = None;
        if stop.sent_count == 1 {
            self.late_answers_until = stop.request_time;
        }
        // Answers come in order; the answer to the line before `stop` is therefore lost.
        match self.pending_request.take() {
            Some((Request::Line(sent_line), ..)) => self.record_failure(sent_line, "no answer"),
            // The next status in which the robot does not walk restores the setting.
            Some((Request::Deadman(DeadmanLine::Restore), ..)) => {
                if let Some(deadman) = &mut self.deadman {
                    deadman.record_unconfirmed();
                }
            }
            Some((Request::Deadman(line), ..)) if line != DeadmanLine::RestoreForOneLine => {
                self.queue.push_front(Request::Deadman(line));
            }
            _ => {}
        }
        self.events.push(Event::Answer(line.to_owned()));
        Some(line.to_owned())
    }

    /// Ends an overdue request, or reports once that a `stop` has no answer; returns the message to the user, if any.
    pub fn time_out_request(&mut self, now: Instant) -> Option<String> {
        if let Some(stop) = &mut self.unanswered_stop
            && !stop.is_reported
            && now >= stop.request_time + SILENCE_TIMEOUT
        {
            stop.is_reported = true;
            let message =
                "(no answer: the robot may still move; stop is repeated until it answers)";
            return Some(message.to_owned());
        }
        let is_overdue = |(.., deadline): &mut (_, _, Instant)| now >= *deadline;
        let (request, ..) = self.pending_request.take_if(is_overdue)?;
        Some(match request {
            Request::Line(line) => {
                let message = format!("(no answer to `{line}`)");
                self.record_failure(line, "no answer");
                message
            }
            Request::Deadman(deadman_line) => self.record_unconfirmed_deadman(deadman_line),
            Request::Status | Request::Watch if self.is_silent => return None,
            Request::Status | Request::Watch => {
                self.is_silent = true;
                "(the robot does not answer)".to_owned()
            }
        })
    }

    fn record_failure(&mut self, line: String, reason: &str) {
        self.failures.push((line, reason.to_owned()));
    }

    /// Succeeds if the robot accepted all lines.
    ///
    /// # Errors
    /// Fails if a line was refused, not answered or not sent; the message names the first such line.
    pub fn check_all_accepted(&self) -> Result<(), Failure> {
        let Some((line, reason)) = self.failures.first() else {
            return Ok(());
        };
        let (failed_count, count) = (self.failures.len(), self.user_line_count);
        Err(Failure::Operation(format!(
            "the robot did not accept {failed_count} of {count} lines, the first `{line}`: {reason}"
        )))
    }

    /// True if no answer is outstanding and no line is queued.
    pub fn is_idle(&self) -> bool {
        self.pending_request.is_none() && self.unanswered_stop.is_none() && self.queue.is_empty()
    }

    /// Returns the robot's latest status.
    pub fn status(&self) -> Option<&Status> {
        self.status.as_ref()
    }

    /// Returns the events since the previous call.
    pub fn take_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }
}

#[cfg(test)]
mod tests;
