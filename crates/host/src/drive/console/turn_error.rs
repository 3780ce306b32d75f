//! Errors that end a dialogue with the user.

use std::io;

use super::link::LinkError;
use crate::Failure;

/// A failure of the connection, the terminal or the recording.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub enum DialogueError {
    /// The connection to the board failed.
    Link(#[from] LinkError),
    /// The terminal could not be read or written.
    Io(#[from] io::Error),
    /// The file of the session could not be written.
    File(#[from] Failure),
}
