//! The dialogue: whose turn it is, what is shown, and what is recorded.
//!
//! The robot answers each line once and in order, and prints other lines in between. The
//! line at the bottom of the console asks for `status` twice a second; these answers are
//! not shown, and a person's line never waits for more than one of them.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use super::status::Status;

/// Interval between two questions for the robot's status.
const POLL: Duration = Duration::from_millis(500);
/// Time that an answer may take.
const PATIENCE: Duration = Duration::from_millis(2000);

/// A line of the dialogue, for a record.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Said {
    /// The person to the robot.
    Sent(String),
    /// The robot's answer to that.
    Answer(String),
    /// The robot, unasked, or before an answer.
    Note(String),
    /// The robot's answer to `status`, which the program asked for.
    Status(String),
}

/// The origin of a question to the robot.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Asked {
    Person(String),
    Poll,
    Watch,
}

/// A question that the robot has not answered; its text is for the person.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Unanswered {
    /// A line of the person.
    #[error("(no answer to `{0}`)")]
    Line(String),
    /// A question of this program.
    #[error("(the robot does not answer)")]
    Program,
}

/// The state of a dialogue with the robot.
#[derive(Debug)]
pub struct Session {
    waiting: Option<(Asked, Instant)>,
    queue: VecDeque<String>,
    polls: bool,
    next_poll: Instant,
    /// The program asks for poses by `watch`, until the person does.
    watches: bool,
    watch_due: bool,
    status: Option<Status>,
    said: Vec<Said>,
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
            said: Vec::new(),
        }
    }

    /// The person's next line.
    pub fn say(&mut self, line: &str) {
        if line.split_whitespace().next() == Some("watch") {
            self.watches = false;
        }
        self.queue.push_back(line.to_owned());
    }

    /// The line to send now, if there is one.
    pub fn due(&mut self, now: Instant) -> Option<String> {
        if self.waiting.is_some() {
            return None;
        }
        let (asked, line) = if self.watch_due {
            self.watch_due = false;
            (Asked::Watch, "watch 1".to_owned())
        } else if let Some(line) = self.queue.pop_front() {
            self.said.push(Said::Sent(line.clone()));
            (Asked::Person(line.clone()), line)
        } else if self.polls && now >= self.next_poll {
            self.next_poll = now + POLL;
            (Asked::Poll, "status".to_owned())
        } else {
            return None;
        };
        self.waiting = Some((asked, now));
        Some(line)
    }

    /// Takes a line of the robot; returns it if it is to be shown.
    pub fn receive(&mut self, line: &str) -> Option<String> {
        let shown = Some(line.to_owned());
        if line.starts_with('#') {
            self.said.push(Said::Note(line.to_owned()));
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
            Some((Asked::Poll, _)) if status.is_some() => {
                self.said.push(Said::Status(line.to_owned()));
                None
            }
            Some((Asked::Watch, _)) => None,
            _ => {
                self.said.push(Said::Answer(line.to_owned()));
                shown
            }
        }
    }

    /// The question whose answer has not come in time.
    pub fn overdue(&mut self, now: Instant) -> Option<Unanswered> {
        let (_, since) = self.waiting.as_ref()?;
        if now.saturating_duration_since(*since) < PATIENCE {
            return None;
        }
        Some(match self.waiting.take()?.0 {
            Asked::Person(line) => Unanswered::Line(line),
            Asked::Poll | Asked::Watch => Unanswered::Program,
        })
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

    /// Returns the lines since the previous call.
    pub fn take_said(&mut self) -> Vec<Said> {
        std::mem::take(&mut self.said)
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
        assert_eq!(session.due(now).as_deref(), Some("status"));
        session.say("walk");
        session.say("speed 50");
        assert_eq!(session.due(now), None, "the status has not come");
        assert_eq!(session.receive(STATUS), None, "nobody asked for it");
        assert_eq!(session.due(now).as_deref(), Some("walk"));
        assert_eq!(session.receive("# fault: x").as_deref(), Some("# fault: x"));
        assert_eq!(session.due(now), None);
        assert_eq!(session.receive("ok walk").as_deref(), Some("ok walk"));
        assert_eq!(session.due(now).as_deref(), Some("speed 50"));
        assert_eq!(
            session.receive("ok speed 50").as_deref(),
            Some("ok speed 50")
        );
        assert!(session.is_idle());
        assert_eq!(session.due(now), None, "the next status is not due");
        assert_eq!(session.due(now + POLL).as_deref(), Some("status"));
        assert!(session.status().is_some_and(Status::walks));
    }

    #[test]
    fn a_status_that_the_person_asks_for_is_shown() {
        let now = Instant::now();
        let mut session = Session::new(now, false, false);
        session.say("status");
        session.due(now);
        assert_eq!(session.receive(STATUS).as_deref(), Some(STATUS));
    }

    #[test]
    fn after_a_reset_nothing_is_waited_for() {
        let now = Instant::now();
        let mut session = Session::new(now, false, true);
        assert_eq!(session.due(now).as_deref(), Some("watch 1"));
        session.receive("ok watch 1");
        session.say("walk");
        session.due(now);
        session.receive("# lizard 0.2.0");
        assert_eq!(
            session.due(now).as_deref(),
            Some("watch 1"),
            "asked for anew"
        );
    }

    #[test]
    fn poses_are_shown_only_if_the_person_asked_for_them() {
        let now = Instant::now();
        let mut session = Session::new(now, false, true);
        session.due(now);
        session.receive("ok watch 1");
        assert_eq!(session.receive("# t=1 pose=1,2,3,4"), None);
        session.say("watch 50");
        session.due(now);
        session.receive("ok watch 50");
        assert!(session.receive("# t=50 pose=1,2,3,4").is_some());
    }

    #[test]
    fn a_missing_answer_is_said_once_and_the_next_line_is_sent() {
        let now = Instant::now();
        let mut session = Session::new(now, false, false);
        session.say("walk");
        session.say("stop");
        session.due(now);
        assert_eq!(session.overdue(now), None);
        let later = now + PATIENCE;
        assert_eq!(
            session.overdue(later).map(|line| line.to_string()),
            Some("(no answer to `walk`)".to_owned())
        );
        assert_eq!(session.overdue(later), None);
        assert_eq!(session.due(later).as_deref(), Some("stop"));
    }

    #[test]
    fn everything_said_is_kept_in_order() {
        let now = Instant::now();
        let mut session = Session::new(now, true, false);
        session.say("walk");
        session.due(now);
        session.receive("# note");
        session.receive("err 1 no");
        session.due(now);
        session.receive(STATUS);
        let said = session.take_said();
        assert_eq!(
            said,
            [
                Said::Sent("walk".to_owned()),
                Said::Note("# note".to_owned()),
                Said::Answer("err 1 no".to_owned()),
                Said::Status(STATUS.to_owned()),
            ]
        );
        assert!(session.take_said().is_empty());
    }
}
