//! The robot's console: commands and their replies.

use std::time::Duration;

/// The robot's reply to a command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reply {
    /// The lines before the answer; each begins with `#`.
    pub notes: Vec<String>,
    /// The answer: `ok ...` or `err ...`.
    pub answer: String,
}

/// A connection to a robot's console. All times are robot time: a simulated robot may run slower or faster than this
/// machine.
pub trait Console {
    /// The error of a failed connection.
    type Error;

    /// Sends a line and waits for the reply.
    ///
    /// # Errors
    /// Fails if the robot does not answer, or the connection is lost.
    fn ask(&mut self, line: &str) -> impl Future<Output = Result<Reply, Self::Error>>;

    /// Waits for a duration of robot time.
    ///
    /// # Errors
    /// Fails if the connection is lost.
    fn pause(&mut self, duration: Duration) -> impl Future<Output = Result<(), Self::Error>>;
}

impl<C: Console> Console for &mut C {
    type Error = C::Error;

    async fn ask(&mut self, line: &str) -> Result<Reply, Self::Error> {
        C::ask(self, line).await
    }

    async fn pause(&mut self, duration: Duration) -> Result<(), Self::Error> {
        C::pause(self, duration).await
    }
}

/// The error for a reply that is not `ok`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReplyError {
    /// The robot refused a line.
    #[error("the robot refuses `{line}`: err {reason}")]
    Refused {
        /// The line that was sent.
        line: String,
        /// The error code and its text.
        reason: String,
    },
    /// The answer has an unknown format.
    #[error("the answer to `{line}` has an unknown format: `{answer}`")]
    UnknownFormat {
        /// The line that was sent.
        line: String,
        /// The answer that was received.
        answer: String,
    },
}

/// The error for a command that the robot did not confirm.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ConsoleError<E> {
    /// The reply is not `ok`.
    #[error(transparent)]
    Reply(#[from] ReplyError),
    /// The connection failed before a reply arrived.
    #[error("{0}")]
    Link(E),
}

impl<E> ConsoleError<E> {
    /// True if the robot refused the line.
    pub fn is_refusal(&self) -> bool {
        matches!(self, Self::Reply(ReplyError::Refused { .. }))
    }
}

/// Sends a line; a refusal is an error.
///
/// # Errors
/// Fails if the connection fails, if the robot refuses the line, or if its answer has an unknown format.
pub async fn send_command<C: Console>(console: &mut C, line: &str) -> crate::Result<Reply, C> {
    let reply = console.ask(line).await.map_err(ConsoleError::Link)?;
    let line = line.to_owned();
    if let Some(reason) = reply.answer.strip_prefix("err ") {
        let reason = reason.to_owned();
        return Err(ReplyError::Refused { line, reason }.into());
    }
    if !reply.answer.starts_with("ok ") {
        let answer = reply.answer;
        return Err(ReplyError::UnknownFormat { line, answer }.into());
    }
    Ok(reply)
}
