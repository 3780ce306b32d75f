//! The commands that are missing from a build because one of their cargo features is off.

use std::ffi::OsString;

use super::command_entry::CommandEntry;
use crate::Failure;
use crate::shared::suggestion::format_suggestion;

/// The features: their names, descriptions of the commands that need them, and true for the features of this build.
const FEATURES: [(&str, &str, bool); 4] = [
    ("simulator", "the simulator", cfg!(feature = "simulator")),
    (
        "paper",
        "the commands that compute",
        cfg!(feature = "paper"),
    ),
    (
        "console",
        "the commands for a board on USB",
        cfg!(feature = "console"),
    ),
    ("parts", "the parts to print", cfg!(feature = "parts")),
];

/// Describes the commands that need the accepted features, for messages.
pub(super) fn describe_features(is_accepted: impl Fn(&str) -> bool) -> String {
    let accepted_features = FEATURES.iter().filter(|(name, ..)| is_accepted(name));
    let descriptions: Vec<&str> = accepted_features.map(|(_, text, _)| *text).collect();
    descriptions.join(" and ")
}

/// True if this build has `feature`.
pub(super) fn is_in_build(feature: &str) -> bool {
    FEATURES
        .iter()
        .any(|(name, _, is_built)| *name == feature && *is_built)
}

/// Lists the commands that are missing from a build with only the features that `has_feature` accepts, for the help;
/// empty for a complete build.
pub(super) fn list_absent(commands: &[CommandEntry], has_feature: impl Fn(&str) -> bool) -> String {
    let is_absent = |command: &&CommandEntry| {
        let mut features = command.needed_features.iter();
        features.any(|feature| !has_feature(feature))
    };
    let absent_commands = commands.iter().filter(is_absent);
    let names: Vec<String> = absent_commands.map(CommandEntry::name).collect();
    if names.is_empty() {
        return String::new();
    }
    let names = names.join(", ");
    let absent_features = describe_features(|feature| !has_feature(feature));
    let platform_note = match has_feature("simulator") {
        true => "",
        false => " The simulator runs on Linux.",
    };
    format!(
        "Not in this program: {names}. It was built without {absent_features}.{platform_note}\n\n"
    )
}

/// The arguments of a command that is missing from this build; they are never read.
#[cfg(not(all(feature = "paper", feature = "simulator")))]
#[derive(clap::Args)]
pub struct AbsentCommandArgs {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    _arguments: Vec<OsString>,
}

/// Returns the failure of a command that is missing from a build; it names the missing features.
pub(super) fn absent_command_failure(
    name: &str,
    needed_features: &[&str],
    has_feature: impl Fn(&str) -> bool,
) -> Failure {
    let is_absent = |feature: &str| needed_features.contains(&feature) && !has_feature(feature);
    let absent_features = describe_features(is_absent);
    let advice = match is_absent("simulator") && !cfg!(target_os = "linux") {
        true => "the simulator runs on Linux",
        false => "`make cli` builds every command",
    };
    Failure::Input(format!(
        "`lizard {name}` is missing: this program was built without {absent_features}; {advice}"
    ))
}

/// Returns the failure for a command that is unknown or missing from a build.
#[allow(dead_code, reason = "a complete build has every command")]
pub(super) fn explain_absence(
    words: &[OsString],
    commands: &[CommandEntry],
    has_feature: impl Fn(&str) -> bool,
) -> Failure {
    let word = words.first().map(|word| word.to_string_lossy());
    let word = word.as_deref().unwrap_or_default();
    let names: Vec<String> = commands.iter().map(CommandEntry::name).collect();
    let is_called =
        |command: &&CommandEntry| command.name() == word || command.aliases.contains(&word);
    let Some(command) = commands.iter().find(is_called) else {
        let suggestion = format_suggestion(word, names.iter().map(String::as_str));
        return Failure::Input(format!(
            "unknown command `{word}`{suggestion}; `lizard --help` lists the commands"
        ));
    };
    absent_command_failure(&command.name(), command.needed_features, has_feature)
}

#[cfg(test)]
mod tests {
    use super::super::KNOWN_COMMANDS;
    use super::*;

    fn absence_message(word: &str, features: &[&str]) -> String {
        let words = [word.into(), "--json".into()];
        let has_feature = |feature: &str| features.contains(&feature);
        explain_absence(&words, KNOWN_COMMANDS, has_feature).to_string()
    }

    #[test]
    fn the_absence_message_names_the_missing_feature() {
        assert_eq!(
            absence_message("sim", &["paper"]),
            "`lizard sim` is missing: this program was built without the simulator; `make cli` builds every command"
        );
        assert!(absence_message("info", &[]).contains("without the commands for a board on USB;"));
        assert!(absence_message("parts", &["console"]).contains("without the parts to print;"));
        assert!(absence_message("monitor", &[]).starts_with("`lizard console` is missing: "));
    }

    #[test]
    fn the_help_lists_exactly_the_missing_commands() {
        assert_eq!(list_absent(KNOWN_COMMANDS, |_| true), "");
        assert_eq!(
            list_absent(KNOWN_COMMANDS, |feature| feature != "simulator"),
            "Not in this program: sim, twin, tune. It was built without the simulator. The \
             simulator runs on Linux.\n\n"
        );
        assert_eq!(
            list_absent(KNOWN_COMMANDS, |feature| feature != "parts"),
            "Not in this program: measure, model, parts, fit. It was built without the parts to print.\n\n"
        );
    }

    #[test]
    fn the_absence_message_omits_features_of_the_build() {
        for (features, absent) in [
            (&["simulator"][..], "without the commands that compute;"),
            (&["paper"][..], "without the simulator;"),
            (&[][..], "the simulator and the commands that compute;"),
        ] {
            let message = absence_message("tune", features);
            assert!(message.contains(absent), "{message}");
        }
    }

    #[test]
    fn an_unknown_command_gets_a_suggestion_if_one_is_similar() {
        assert_eq!(
            absence_message("fly", &[]),
            "unknown command `fly`; `lizard --help` lists the commands"
        );
        assert!(absence_message("claibrate", &[]).contains("; did you mean `calibrate`?"));
    }
}
