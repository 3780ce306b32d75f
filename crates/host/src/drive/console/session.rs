//! The dialogue with the robot: the next line to send, the lines to show, and the events to
//! record.
//!
//! The robot answers each line once and in order, and prints other lines in between. The
//! line at the bottom of the console asks for `status` twice a second; these answers are
//! not shown, and a user's line never waits for more than one of them. A program that sends a
//! script has to learn that a line was refused, so failed lines are counted.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use super::recorder::Event;
use super::status::Status;
use crate::Failure;

/// Interval between two questions for the robot's status.
const POLL: Duration = Duration::from_millis(500);
/// Time that an answer may take.
const PATIENCE: Duration = Duration::from_millis(2000);

/// A line that waits for its answer.
#[derive(Debug)]
enum Question {
    /// A line of the user.
    Line(String),
    /// `status`, by this program.
    Status,
    /// `watch`, by this program.
    Watch,
}

/// The state of a dialogue with the robot.
#[derive(Debug)]
pub struct Session {
    waiting: Option<(Question, Instant)>,
    queue: VecDeque<String>,
    polls: bool,
    next_poll: Instant,
    /// True while the program asks for poses by `watch`, until the user does.
    watches: bool,
    watch_due: bool,
    status: Option<Status>,
    events: Vec<Event>,
    sent: usize,
    failed: usize,
    /// The first line that failed, and the reason.
    first_failed: Option<(String, String)>,
}

impl Session {
    /// A dialogue that begins now. `polls`: ask for the status; `watches`: ask for
    /// every pose.
    #[must_use]
    pub fn new(now: Instant, polls: bool, watches: bool) -> Self {
        Self {
            waiting: None,
            queue: VecDeque::new(),
            polls,
            next_poll: now,
            watches,
            watch_due: watches,
            status: None,
            events: Vec::new(),
            sent: 0,
            failed: 0,
            first_failed: None,
        }
    }

    /// Queues a line of the user.
    pub fn queue(&mut self, line: &str) {
        if line.split_whitespace().next() == Some("watch") {
            self.watches = false;
        }
        self.queue.push_back(line.to_owned());
    }

    /// The line to send now, if there is one.
    pub fn next_line(&mut self, now: Instant) -> Option<String> {
        if self.waiting.is_some() {
            return None;
        }
        let (question, line) = if self.watch_due {
            self.watch_due = false;
            (Question::Watch, "watch 1".to_owned())
        } else if let Some(line) = self.queue.pop_front() {
            self.sent += 1;
            self.events.push(Event::Sent(line.clone()));
            (Question::Line(line.clone()), line)
        } else if self.polls && now >= self.next_poll {
            self.next_poll = now + POLL;
            (Question::Status, "status".to_owned())
        } else {
            return None;
        };
        self.waiting = Some((question, now));
        Some(line)
    }

    /// Takes a line of the robot; returns it if it is to be shown.
    pub fn receive(&mut self, line: &str) -> Option<String> {
        let shown = Some(line.to_owned());
        if line.starts_with('#') {
            self.events.push(Event::of_note(line));
            if line.starts_with("# lizard ") {
                // The board has restarted, and has forgotten the question.
                self.waiting = None;
                self.watch_due = self.watches;
            }
            return shown.filter(|_| !(self.watches && line.starts_with("# t=")));
        }
        let status = Status::parse(line);
        self.status = status.clone().or(self.status.take());
        match self.waiting.take() {
            Some((Question::Status, _)) if status.is_some() => {
                self.events.push(Event::Status(line.to_owned()));
                return None;
            }
            Some((Question::Watch, _)) => return None,
            Some((Question::Line(sent), _)) if line.starts_with("err ") => self.fail(sent, line),
            _ => {}
        }
        self.events.push(Event::Answer(line.to_owned()));
        shown
    }

    /// The message about a question whose answer has not come in time.
    pub fn overdue(&mut self, now: Instant) -> Option<String> {
        let is_late = |since: Instant| now.saturating_duration_since(since) >= PATIENCE;
        let (question, _) = self.waiting.take_if(|(_, since)| is_late(*since))?;
        Some(match question {
            Question::Line(line) => {
                let message = format!("(no answer to `{line}`)");
                self.fail(line, "no answer");
                message
            }
            Question::Status | Question::Watch => "(the robot does not answer)".to_owned(),
        })
    }

    fn fail(&mut self, line: String, why: &str) {
        self.failed += 1;
        self.first_failed.get_or_insert((line, why.to_owned()));
    }

    /// Succeeds if the robot accepted all lines.
    ///
    /// # Errors
    /// It did not; the sentence names the first such line.
    pub fn verdict(&self) -> Result<(), Failure> {
        let Some((line, why)) = &self.first_failed else {
            return Ok(());
        };
        Err(Failure::Impossible(format!(
            "the robot did not take {} of {} lines, the first `{line}`: {why}",
            self.failed, self.sent
        )))
    }

    /// True if no answer is outstanding and no line is queued.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.waiting.is_none() && self.queue.is_empty()
    }

    /// The latest status.
    #[must_use]
    pub fn status(&self) -> Option<&Status> {
        self.status.as_ref()
    }

    /// Returns the events since the previous call.
    pub fn take_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATUS: &str = "ok gait=walk phase=0 pose=1,2,3,4 margin=0.5 guard=clear fault=none";

    #[test]
    fn a_persons_line_is_sent_when_the_answer_before_it_has_come() {
        let now = Instant::now();
        let mut session = Session::new(now, true, false);
        assert_eq!(session.next_line(now).as_deref(), Some("status"));
        session.queue("walk");
        session.queue("speed 50");
        assert_eq!(session.next_line(now), None, "the status has not come");
        assert_eq!(session.receive(STATUS), None, "the user did not ask for it");
        assert_eq!(session.next_line(now).as_deref(), Some("walk"));
        assert_eq!(session.receive("# fault: x").as_deref(), Some("# fault: x"));
        assert_eq!(session.next_line(now), None);
        assert_eq!(session.receive("ok walk").as_deref(), Some("ok walk"));
        assert_eq!(session.next_line(now).as_deref(), Some("speed 50"));
        assert_eq!(
            session.receive("ok speed 50").as_deref(),
            Some("ok speed 50")
        );
        assert!(session.is_idle());
        assert_eq!(session.next_line(now), None, "the next status is not due");
        assert_eq!(session.next_line(now + POLL).as_deref(), Some("status"));
        assert!(session.status().is_some_and(Status::walks));
    }

    #[test]
    fn a_status_that_the_person_asks_for_is_shown() {
        let now = Instant::now();
        let mut session = Session::new(now, false, false);
        session.queue("status");
        session.next_line(now);
        assert_eq!(session.receive(STATUS).as_deref(), Some(STATUS));
    }

    #[test]
    fn after_a_reset_nothing_is_waited_for() {
        let now = Instant::now();
        let mut session = Session::new(now, false, true);
        assert_eq!(session.next_line(now).as_deref(), Some("watch 1"));
        session.receive("ok watch 1");
        session.queue("walk");
        session.next_line(now);
        session.receive("# lizard 0.2.0");
        assert_eq!(
            session.next_line(now).as_deref(),
            Some("watch 1"),
            "asked for again"
        );
    }

    #[test]
    fn poses_are_shown_only_if_the_person_asked_for_them() {
        let now = Instant::now();
        let mut session = Session::new(now, false, true);
        session.next_line(now);
        session.receive("ok watch 1");
        assert_eq!(session.receive("# t=1 pose=1,2,3,4"), None);
        session.queue("watch 50");
        session.next_line(now);
        session.receive("ok watch 50");
        assert!(session.receive("# t=50 pose=1,2,3,4").is_some());
    }

    #[test]
    fn a_missing_answer_is_reported_once_and_the_next_line_is_sent() {
        let now = Instant::now();
        let mut session = Session::new(now, false, false);
        session.queue("walk");
        session.queue("stop");
        session.next_line(now);
        assert_eq!(session.overdue(now), None);
        let later = now + PATIENCE;
        assert_eq!(
            session.overdue(later).as_deref(),
            Some("(no answer to `walk`)")
        );
        assert_eq!(session.overdue(later), None);
        assert_eq!(session.next_line(later).as_deref(), Some("stop"));
    }

    #[test]
    fn every_event_is_kept_in_order() {
        let now = Instant::now();
        let mut session = Session::new(now, true, false);
        session.queue("walk");
        session.next_line(now);
        session.receive("# note");
        session.receive("err 1 no");
        session.next_line(now);
        session.receive(STATUS);
        let events = session.take_events();
        assert_eq!(
            events,
            [
                Event::Sent("walk".to_owned()),
                Event::Note("# note".to_owned()),
                Event::Answer("err 1 no".to_owned()),
                Event::Status(STATUS.to_owned()),
            ]
        );
        assert!(session.take_events().is_empty());
    }

    #[test]
    fn lines_that_fail_are_counted_once_and_the_first_is_named() {
        let now = Instant::now();
        let mut session = Session::new(now, false, false);
        let mut ask = |line: &str, answer: Option<&str>| {
            session.queue(line);
            session.next_line(now);
            match answer {
                Some(answer) => drop(session.receive(answer)),
                None => drop(session.overdue(now + PATIENCE)),
            }
            session.verdict().map_err(|failure| failure.to_string())
        };
        assert_eq!(ask("walk", Some("ok walk")), Ok(()));
        let first =
            |count| format!("the robot did not take {count} lines, the first `fly`: err 1 no");
        assert_eq!(ask("fly", Some("err 1 no")), Err(first("1 of 2")));
        assert_eq!(ask("swim", Some("err 2 no")), Err(first("2 of 3")));
        assert_eq!(ask("stop", None), Err(first("3 of 4")));
        session.receive("err 3 late");
        assert!(
            session
                .verdict()
                .is_err_and(|it| it.to_string() == first("3 of 4"))
        );
    }
}
