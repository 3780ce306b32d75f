//! The failure that ends the program, with a message for the user and an exit code.

use std::io;

/// The reason why a subcommand ended without a result.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// An argument or a line of input is invalid.
    #[error("{0}")]
    Input(String),
    /// robot.toml is missing or invalid.
    #[error("{0}")]
    Robot(#[from] lizard_robot::Error),
    /// The command is valid, but could not be carried out.
    #[error("{0}")]
    Impossible(String),
    /// Standard input, standard output or the terminal failed. An error of a file or a port is not reported by this
    /// variant, because its message must name the file or the port.
    #[error("standard input or output: {0}")]
    Io(#[from] io::Error),
}

impl Failure {
    /// The program's exit code: 2 for invalid input, 1 for everything else.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) | Self::Robot(_) => 2,
            Self::Impossible(_) | Self::Io(_) => 1,
        }
    }

    /// True if the reader of standard output has closed the pipe, as in `lizard ... | head`, which is not an error.
    pub fn is_silent(&self) -> bool {
        matches!(self, Self::Io(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }
}

impl From<lizard_kinematics::Infeasible> for Failure {
    fn from(infeasible: lizard_kinematics::Infeasible) -> Self {
        Self::Impossible(infeasible.to_string())
    }
}

impl From<serde_json::Error> for Failure {
    /// Treats the error as a failed write, because the program's own values can always be serialized.
    fn from(error: serde_json::Error) -> Self {
        Self::Io(error.into())
    }
}
