//! The rows of the table of commands, and their groups.

/// A group of commands, with its heading in the help.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Group {
    /// Commands for a board, real or simulated.
    Drive,
    /// Simulations of the firmware and of the body.
    Simulate,
    /// Parts and drawings.
    Build,
    /// Gaits and measures in robot.toml.
    Change,
    /// The paper's figures.
    Paper,
    /// Scripts and development.
    Itself,
}

impl Group {
    /// All groups in the order of the help; the groups for owners of a robot come first.
    pub(super) const ALL: [Self; 6] = [
        Self::Drive,
        Self::Simulate,
        Self::Build,
        Self::Change,
        Self::Paper,
        Self::Itself,
    ];

    /// The text of the heading.
    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Drive => "Drive the robot",
            Self::Simulate => "Simulate it",
            Self::Build => "Build it",
            Self::Change => "Change its gaits and measures",
            Self::Paper => "The paper, computed",
            Self::Itself => "For scripts and development",
        }
    }
}

/// A command of the program, whether or not this build has it.
#[derive(Debug, Clone, Copy)]
pub(super) struct CommandEntry {
    pub(super) group: Group,
    /// The name of the command's variant in the enum of commands.
    pub(super) variant: &'static str,
    /// Aliases of the command.
    pub(super) aliases: &'static [&'static str],
    /// The cargo features that the command needs.
    pub(super) needs: &'static [&'static str],
}

impl CommandEntry {
    /// The name that the user types.
    pub(super) fn name(&self) -> String {
        self.variant.to_lowercase()
    }
}
