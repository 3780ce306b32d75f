//! An entry in the list of commands.

/// The heading of the commands for scripts and development, which the help lists by name only.
pub(super) const DEVELOPMENT: &str = "For scripts and development";

/// A command of the program, which may be missing from this build.
#[derive(Debug, Clone, Copy)]
pub(super) struct CommandEntry {
    /// The heading of the command's group in the help.
    pub(super) group: &'static str,
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
