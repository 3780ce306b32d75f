//! The commands that are missing from a build because one of their cargo features is off.

use std::ffi::OsString;

use super::command_entry::CommandEntry;
use crate::Failure;
use crate::shared::suggestion::format_suggestion;

/// Describes the commands that need `feature`, for messages.
pub(super) fn describe_feature(feature: &str) -> &'static str {
    match feature {
        "simulator" => "the simulator",
        "paper" => "the commands that compute",
        "console" => "the commands for a board on USB",
        "parts" => "the parts to print",
        _ => "",
    }
}

/// True if this build has `feature`.
fn is_in_build(feature: &str) -> bool {
    let features = [
        ("simulator", cfg!(feature = "simulator")),
        ("paper", cfg!(feature = "paper")),
        ("console", cfg!(feature = "console")),
        ("parts", cfg!(feature = "parts")),
    ];
    features.contains(&(feature, true))
}

/// Lists the commands that are missing from this build, for the help; empty for a complete build.
pub(super) fn list_absent(commands: &[CommandEntry]) -> String {
    list_absent_in_build(commands, is_in_build)
}

/// Lists the commands that are missing from a build with only the features that `has_feature` accepts.
fn list_absent_in_build(commands: &[CommandEntry], has_feature: impl Fn(&str) -> bool) -> String {
    let absent_commands = commands.iter().filter(|command| {
        !command
            .needed_features
            .iter()
            .all(|feature| has_feature(feature))
    });
    let names: Vec<String> = absent_commands.map(CommandEntry::name).collect();
    if names.is_empty() {
        return String::new();
    }
    let features = ["simulator", "paper", "console", "parts"].into_iter();
    let absent_features = features.filter(|feature| !has_feature(feature));
    let absent_features: Vec<&str> = absent_features.map(describe_feature).collect();
    let platform_note = match has_feature("simulator") {
        true => "",
        false => " The simulator runs on Linux.",
    };
    format!(
        "Not in this program: {}. It was built without {}.{platform_note}\n\n",
        names.join(", "),
        absent_features.join(" and ")
    )
}

/// Returns the failure for a command that is unknown or missing from this build.
#[cfg_attr(
    all(
        feature = "simulator",
        feature = "paper",
        feature = "console",
        feature = "parts"
    ),
    allow(dead_code, reason = "a complete build has every command")
)]
pub(super) fn explain_absence(words: &[OsString], commands: &[CommandEntry]) -> Failure {
    explain_absence_in_build(words, commands, is_in_build)
}

/// The arguments of a command that is missing from this build; they are never read.
#[cfg(not(all(feature = "paper", feature = "simulator")))]
#[derive(clap::Args)]
pub struct AbsentCommand {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    _arguments: Vec<OsString>,
}

#[cfg(not(all(feature = "paper", feature = "simulator")))]
impl AbsentCommand {
    /// Returns the failure of a missing command; it names the missing features.
    pub fn failure(name: &str, needed_features: &[&str]) -> Failure {
        absent_command_failure(name, needed_features, is_in_build)
    }
}

fn absent_command_failure(
    name: &str,
    needed_features: &[&str],
    has_feature: impl Fn(&str) -> bool,
) -> Failure {
    let absent_features: Vec<&str> = needed_features
        .iter()
        .filter(|feature| !has_feature(feature))
        .map(|feature| describe_feature(feature))
        .collect();
    let is_simulator_absent = needed_features.contains(&"simulator") && !has_feature("simulator");
    let advice = match is_simulator_absent && !cfg!(target_os = "linux") {
        true => "the simulator runs on Linux",
        false => "`make cli` builds every command",
    };
    Failure::Input(format!(
        "`lizard {name}` is missing: this program was built without {}; {advice}",
        absent_features.join(" and ")
    ))
}

fn explain_absence_in_build(
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
        explain_absence_in_build(&[word.into(), "--json".into()], KNOWN_COMMANDS, |feature| {
            features.contains(&feature)
        })
        .to_string()
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
        assert_eq!(list_absent_in_build(KNOWN_COMMANDS, |_| true), "");
        assert_eq!(
            list_absent_in_build(KNOWN_COMMANDS, |feature| feature != "simulator"),
            "Not in this program: sim, twin, tune. It was built without the simulator. The \
             simulator runs on Linux.\n\n"
        );
        assert_eq!(
            list_absent_in_build(KNOWN_COMMANDS, |feature| feature != "parts"),
            "Not in this program: measure, model, parts, fit. It was built without the parts to print.\n\n"
        );
    }

    #[test]
    fn the_absence_message_omits_features_of_the_build() {
        assert!(
            absence_message("tune", &["simulator"]).contains("without the commands that compute;")
        );
        assert!(absence_message("tune", &["paper"]).contains("without the simulator;"));
        let message = absence_message("tune", &[]);
        assert!(
            message.contains("the simulator and the commands that compute;"),
            "{message}"
        );
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
