//! An entry in the list of commands, and the groups of entries.

/// A group of commands, with its heading in the help.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CommandGroup {
    /// Commands for a board, real or simulated.
    Drive,
    /// Simulations of the firmware and the body.
    Simulate,
    /// Parts and drawings.
    Build,
    /// Changes of gaits and dimensions in robot.toml.
    Change,
    /// Results of the paper, computed for any robot.
    Paper,
    /// Commands for scripts and for program development.
    Development,
}

impl CommandGroup {
    /// All groups in the order of the help; the groups for owners of a robot come first.
    pub(super) const ALL: [Self; 6] = [
        Self::Drive,
        Self::Simulate,
        Self::Build,
        Self::Change,
        Self::Paper,
        Self::Development,
    ];

    /// The text of the heading.
    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Drive => "Drive the robot",
            Self::Simulate => "Simulate it",
            Self::Build => "Build it",
            Self::Change => "Change its gaits and dimensions",
            Self::Paper => "The paper, computed",
            Self::Development => "For scripts and development",
        }
    }
}

/// A command of the program, which may be missing from this build.
#[derive(Debug, Clone, Copy)]
pub(super) struct CommandEntry {
    pub(super) group: CommandGroup,
    /// The name of the command's variant in the enum of commands.
    pub(super) variant: &'static str,
    /// Other names that the user may type.
    pub(super) aliases: &'static [&'static str],
    /// The cargo features that the command needs.
    pub(super) needed_features: &'static [&'static str],
}

impl CommandEntry {
    /// The name that the user types.
    pub(super) fn name(&self) -> String {
        self.variant.to_lowercase()
    }
}
