//! Commands that a program built without one of its cargo features lacks.

use std::ffi::OsString;

use super::known::Known;
use crate::Failure;
use crate::shared::suggestion::did_you_mean;

/// The description of the commands that need this feature.
pub(super) fn words(feature: &str) -> &'static str {
    match feature {
        "simulator" => "the simulator",
        "paper" => "the commands that compute",
        "console" => "the commands for a board on USB",
        "parts" => "the parts to print",
        _ => "",
    }
}

/// True if this build has the feature.
fn is_built(feature: &str) -> bool {
    let features = [
        ("simulator", cfg!(feature = "simulator")),
        ("paper", cfg!(feature = "paper")),
        ("console", cfg!(feature = "console")),
        ("parts", cfg!(feature = "parts")),
    ];
    features.contains(&(feature, true))
}

/// Explains why this build has no command of this name.
#[cfg_attr(
    all(
        feature = "simulator",
        feature = "paper",
        feature = "console",
        feature = "parts"
    ),
    allow(dead_code, reason = "a complete build lacks nothing")
)]
pub(super) fn explain(typed: &[OsString], known: &[Known]) -> Failure {
    explain_in_build(typed, known, is_built)
}

fn explain_in_build(typed: &[OsString], known: &[Known], has: impl Fn(&str) -> bool) -> Failure {
    let word = typed.first().map(|word| word.to_string_lossy());
    let word = word.as_deref().unwrap_or_default();
    let names: Vec<String> = known.iter().map(Known::name).collect();
    let called = |known: &&Known| known.name() == word || known.also.contains(&word);
    let Some(known) = known.iter().find(called) else {
        let like = did_you_mean(word, names.iter().map(String::as_str));
        return Failure::Input(format!(
            "there is no command `{word}`{like}; lizard --help lists them"
        ));
    };
    let without: Vec<&str> = known
        .needs
        .iter()
        .filter(|feature| !has(feature))
        .map(|feature| words(feature))
        .collect();
    Failure::Input(format!(
        "`lizard {}` is missing: this program was built without {}; make cli builds all",
        known.name(),
        without.join(" and ")
    ))
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
        assert!(message("backup", &[]).contains("without the commands for a board on USB;"));
        assert!(message("parts", &["console"]).contains("without the parts to print;"));
        assert!(message("monitor", &[]).starts_with("`lizard console` is missing: "));
    }

    #[test]
    fn of_two_features_only_the_absent_ones_are_named() {
        assert!(message("tune", &["simulator"]).contains("without the commands that compute;"));
        assert!(message("tune", &["paper"]).contains("without the simulator;"));
        assert!(message("replay", &[]).contains("a board on USB and the simulator;"));
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
