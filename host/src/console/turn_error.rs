//! Why a dialogue with a person does not go on.

use std::io;

use super::link::LinkError;

/// The connection or the terminal has failed.
#[derive(Debug)]
pub enum TurnError {
    /// The connection to the board.
    Link(LinkError),
    /// The terminal, or a file of the session.
    Io(io::Error),
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
