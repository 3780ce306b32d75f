//! The commands that this build lacks because it was built without one of the cargo features.

use std::ffi::OsString;

use super::known::CommandEntry;
use crate::Failure;
use crate::shared::suggestion::did_you_mean;

/// Describes the commands that need a feature, for messages.
pub(super) fn describe_feature(feature: &str) -> &'static str {
    match feature {
        "simulator" => "the simulator",
        "paper" => "the commands that compute",
        "console" => "the commands for a board on USB",
        "parts" => "the parts to print",
        _ => "",
    }
}

/// True if this build has a feature.
fn is_built(feature: &str) -> bool {
    let features = [
        ("simulator", cfg!(feature = "simulator")),
        ("paper", cfg!(feature = "paper")),
        ("console", cfg!(feature = "console")),
        ("parts", cfg!(feature = "parts")),
    ];
    features.contains(&(feature, true))
}

/// Lists the commands that this build lacks, for the help; empty for a complete build.
pub(super) fn list_absent(commands: &[CommandEntry]) -> String {
    list_in_build(commands, is_built)
}

fn list_in_build(commands: &[CommandEntry], has: impl Fn(&str) -> bool) -> String {
    let lacks = commands
        .iter()
        .filter(|commands| !commands.needs.iter().all(|feature| has(feature)));
    let names: Vec<String> = lacks.map(CommandEntry::name).collect();
    if names.is_empty() {
        return String::new();
    }
    let features = ["simulator", "paper", "console", "parts"];
    let without = features.into_iter().filter(|feature| !has(feature));
    let without: Vec<&str> = without.map(describe_feature).collect();
    let on = match has("simulator") {
        true => "",
        false => " The simulator runs on Linux.",
    };
    format!(
        "Not in this program: {}. It was built without {}.{on}\n\n",
        names.join(", "),
        without.join(" and ")
    )
}

/// Explains why this build lacks the command that was typed.
#[cfg_attr(
    all(
        feature = "simulator",
        feature = "paper",
        feature = "console",
        feature = "parts"
    ),
    allow(dead_code, reason = "a complete build lacks nothing")
)]
pub(super) fn explain(typed: &[OsString], commands: &[CommandEntry]) -> Failure {
    explain_in_build(typed, commands, is_built)
}

/// The arguments of a command that this build lacks; nothing reads them.
#[cfg(not(all(feature = "paper", feature = "simulator")))]
#[derive(clap::Args)]
pub struct AbsentCommand {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    _arguments: Vec<OsString>,
}

#[cfg(not(all(feature = "paper", feature = "simulator")))]
impl AbsentCommand {
    /// Explains why this build lacks this command.
    pub fn failure(name: &str, needs: &[&str]) -> Failure {
        missing_command_failure(name, needs, is_built)
    }
}

fn missing_command_failure(name: &str, needs: &[&str], has: impl Fn(&str) -> bool) -> Failure {
    let without: Vec<&str> = needs
        .iter()
        .filter(|feature| !has(feature))
        .map(|feature| describe_feature(feature))
        .collect();
    let no_simulator = needs.contains(&"simulator") && !has("simulator");
    let all = match no_simulator && !cfg!(target_os = "linux") {
        true => "the simulator runs on Linux",
        false => "make cli builds all",
    };
    Failure::Input(format!(
        "`lizard {name}` is missing: this program was built without {}; {all}",
        without.join(" and ")
    ))
}

fn explain_in_build(
    typed: &[OsString],
    known: &[CommandEntry],
    has: impl Fn(&str) -> bool,
) -> Failure {
    let word = typed.first().map(|word| word.to_string_lossy());
    let word = word.as_deref().unwrap_or_default();
    let names: Vec<String> = known.iter().map(CommandEntry::name).collect();
    let called = |known: &&CommandEntry| known.name() == word || known.aliases.contains(&word);
    let Some(known) = known.iter().find(called) else {
        let like = did_you_mean(word, names.iter().map(String::as_str));
        return Failure::Input(format!(
            "there is no command `{word}`{like}; lizard --help lists them"
        ));
    };
    missing_command_failure(&known.name(), known.needs, has)
}

#[cfg(test)]
mod tests {
    use super::super::KNOWN;
    use super::*;

    fn message(word: &str, features: &[&str]) -> String {
        explain_in_build(&[word.into(), "--json".into()], KNOWN, |feature| {
            features.contains(&feature)
        })
        .to_string()
    }

    #[test]
    fn a_command_of_an_absent_feature_says_how_to_get_it() {
        assert_eq!(
            message("sim", &["paper"]),
            "`lizard sim` is missing: this program was built without the simulator; make cli builds all"
        );
        assert!(message("info", &[]).contains("without the commands for a board on USB;"));
        assert!(message("parts", &["console"]).contains("without the parts to print;"));
        assert!(message("monitor", &[]).starts_with("`lizard console` is missing: "));
    }

    #[test]
    fn the_help_names_exactly_the_commands_that_a_build_lacks() {
        assert_eq!(list_in_build(KNOWN, |_| true), "");
        assert_eq!(
            list_in_build(KNOWN, |feature| feature != "simulator"),
            "Not in this program: sim, twin, tune. It was built without the simulator. The \
             simulator runs on Linux.\n\n"
        );
        assert_eq!(
            list_in_build(KNOWN, |feature| feature != "parts"),
            "Not in this program: measure, model, parts, fit. It was built without the parts to print.\n\n"
        );
    }

    #[test]
    fn of_two_features_only_the_absent_ones_are_named() {
        assert!(message("tune", &["simulator"]).contains("without the commands that compute;"));
        assert!(message("tune", &["paper"]).contains("without the simulator;"));
        let both = message("tune", &[]);
        assert!(
            both.contains("the simulator and the commands that compute;"),
            "{both}"
        );
    }

    #[test]
    fn a_mistyped_command_is_answered_with_a_suggestion() {
        assert_eq!(
            message("fly", &[]),
            "there is no command `fly`; lizard --help lists them"
        );
        assert!(message("claibrate", &[]).contains("; did you mean `calibrate`?"));
    }
}
