//! What the dialogue sends: the lines that wait to be sent or for their answers, and an unanswered `stop`.

use std::time::Instant;

use super::super::deadman::DeadmanLine;

/// A line that waits to be sent, or for its answer.
#[derive(Debug)]
pub(super) enum Request {
    /// A user's line.
    Line(String),
    /// The program's own `status`.
    Status,
    /// The program's own `watch`.
    Watch,
    /// The program's own line about `deadman`.
    Deadman(DeadmanLine),
}

/// An unanswered `stop`.
#[derive(Debug)]
pub(super) struct UnansweredStop {
    /// Time of the user's request, or of the board's reconnection.
    pub(super) request_time: Instant,
    /// Time of the next `stop` line.
    pub(super) next_send_time: Instant,
    /// Number of `stop` lines sent.
    pub(super) sent_count: u32,
    /// True once the user has been informed of the missing answer.
    pub(super) is_reported: bool,
}

impl UnansweredStop {
    pub(super) fn new(now: Instant) -> Self {
        Self {
            request_time: now,
            next_send_time: now,
            sent_count: 0,
            is_reported: false,
        }
    }
}
