//! Errors that end a dialogue with the user.

use std::io;

use super::link::LinkError;
use crate::Failure;

/// The connection or the terminal has failed.
#[derive(Debug)]
pub enum TurnError {
    /// The connection to the board.
    Link(LinkError),
    /// The terminal cannot be read or written.
    Io(io::Error),
    /// The file of the session.
    File(Failure),
}

impl From<LinkError> for TurnError {
    fn from(error: LinkError) -> Self {
        Self::Link(error)
    }
}

impl From<io::Error> for TurnError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<Failure> for TurnError {
    fn from(failure: Failure) -> Self {
        Self::File(failure)
    }
}
