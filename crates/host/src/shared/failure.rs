//! The failure that ends the program, with a message for the user and an exit code.

use std::io;

/// The error that ended a command without a result.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// An argument or a line of input is invalid.
    #[error("{0}")]
    Input(String),
    /// robot.toml is missing or invalid.
    #[error("{0}")]
    Robot(#[from] lizard_robot::Error),
    /// The operation failed, although the command is valid.
    #[error("{0}")]
    Operation(String),
    /// Standard input, standard output or the terminal failed. Errors of files and ports use another variant because
    /// their messages must name the file or port.
    #[error("standard input or output: {0}")]
    Io(#[from] io::Error),
}

impl Failure {
    /// Returns the program's exit code: 2 for invalid input, 1 for everything else.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) | Self::Robot(_) => 2,
            Self::Operation(_) | Self::Io(_) => 1,
        }
    }

    /// True if the reader of standard output has closed the pipe, as in `lizard ... | head`, which is not an error.
    pub fn is_silent(&self) -> bool {
        matches!(self, Self::Io(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }
}

impl From<lizard_kinematics::InfeasiblePose> for Failure {
    fn from(infeasible: lizard_kinematics::InfeasiblePose) -> Self {
        Self::Operation(infeasible.to_string())
    }
}

impl From<serde_json::Error> for Failure {
    /// Treats the error as a failed write, because the program's own values can always be serialized.
    fn from(error: serde_json::Error) -> Self {
        Self::Io(error.into())
    }
}
