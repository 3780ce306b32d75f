//! The errors that end a dialogue between the user and the robot.

use std::io;

use super::link::LinkError;
use crate::Failure;

/// A failure of the connection, the terminal or the recording.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub enum DialogueError {
    /// The connection to the board failed.
    Link(#[from] LinkError),
    /// The terminal, standard input or standard output failed.
    Io(#[from] io::Error),
    /// The session's file could not be written.
    File(#[from] Failure),
}
