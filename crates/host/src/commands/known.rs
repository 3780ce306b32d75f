//! A row of the table of commands.

/// The heading of a command in the help.
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
    /// All headings in the order of the help, the owner's first.
    pub(super) const ALL: [Self; 6] = [
        Self::Drive,
        Self::Simulate,
        Self::Build,
        Self::Change,
        Self::Paper,
        Self::Itself,
    ];

    /// The words of the heading.
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
    /// The command's variant of the enum of commands.
    pub(super) variant: &'static str,
    /// Aliases of the command.
    pub(super) also: &'static [&'static str],
    /// The cargo features that it needs.
    pub(super) needs: &'static [&'static str],
}

impl CommandEntry {
    /// The name that the user types.
    pub(super) fn name(&self) -> String {
        self.variant.to_lowercase()
    }
}
