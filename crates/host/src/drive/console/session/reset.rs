//! What the dialogue does after the board was reset or connected again.

use std::time::Instant;

use super::super::deadman::{Deadman, DeadmanLine};
use super::Session;
use super::request::{Request, UnansweredStop};

impl Session {
    /// Starts over with a board that was connected again. An unanswered `stop` is repeated. A board that was not reset
    /// may still have the `deadman` for driving. The user's other waiting lines are dropped; returns a message about
    /// each of them.
    pub fn restart(&mut self, now: Instant, watches_poses: bool, is_reset: bool) -> Vec<String> {
        let pending_request = self.pending_request.take().map(|(request, ..)| request);
        let requests = pending_request.into_iter().chain(self.queue.drain(..));
        let to_message = |request| match request {
            Request::Line(line) => Some(format!("(not sent or not answered: `{line}`)")),
            _ => None,
        };
        let messages = requests.filter_map(to_message).collect();
        let unanswered_stop = self.unanswered_stop.take();
        let mut deadman = Deadman::default();
        if !is_reset {
            deadman = self.deadman.take().unwrap_or_default();
            deadman.record_unconfirmed();
        }
        *self = Self {
            deadman: Some(deadman),
            frame_count: if is_reset { 0 } else { self.frame_count },
            // The board could not answer while it was unplugged.
            unanswered_stop: unanswered_stop.map(|_| UnansweredStop::new(now)),
            events: self.take_events(),
            ..Self::new(now, self.polls_status, watches_poses)
        };
        messages
    }

    /// Starts over with a robot whose banner has arrived.
    pub(super) fn begin_after_reset(&mut self) {
        self.is_watch_due = self.watches_poses;
        self.deadman = self.deadman.take().map(|_| Deadman::default());
        self.frame_count = 0;
        // The queued lines about `deadman` belong to the time before the reset.
        self.plan_queue_again();
    }

    /// Plans the lines about `deadman` again for the queued lines of the user.
    pub(super) fn plan_queue_again(&mut self) {
        for request in std::mem::take(&mut self.queue) {
            if let Request::Line(line) = request {
                self.queue(&line);
            }
        }
    }

    /// Notices a reset whose banner the link has lost: the robot then reports fewer frames than before. The link may
    /// also have damaged the number, so a robot that was driven stays driven: `deadman` is set again.
    pub(super) fn receive_frame_count(&mut self, frame_count: u64) {
        let is_reset = frame_count < self.frame_count;
        self.frame_count = frame_count;
        if !is_reset {
            return;
        }
        self.is_watch_due = self.watches_poses;
        let was_driven = self.is_driven();
        let read = Request::Deadman(DeadmanLine::Read);
        let is_read_due = self
            .queue
            .iter()
            .any(|request| matches!(request, Request::Deadman(DeadmanLine::Read)));
        if let Some(deadman) = &mut self.deadman {
            deadman.record_unconfirmed();
        }
        self.plan_queue_again();
        if was_driven {
            self.queue.push_front(Request::Deadman(DeadmanLine::Set));
        }
        if is_read_due {
            self.queue.push_front(read);
        }
    }
}
