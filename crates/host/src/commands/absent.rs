//! Commands that a program built without one of its cargo features lacks.

use std::ffi::OsString;

use super::known::Known;
use crate::Failure;
use crate::shared::suggestion::did_you_mean;

/// The commands that a build without this feature lacks, in words.
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
fn built(feature: &str) -> bool {
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
    allow(dead_code, reason = "a whole build lacks nothing")
)]
pub(super) fn explain(typed: &[OsString], known: &[Known]) -> Failure {
    in_a_build(typed, known, built)
}

fn in_a_build(typed: &[OsString], known: &[Known], has: impl Fn(&str) -> bool) -> Failure {
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

    fn said(word: &str, features: &[&str]) -> String {
        in_a_build(&[word.into(), "--json".into()], KNOWN, |feature| {
            features.contains(&feature)
        })
        .to_string()
    }

    #[test]
    fn a_command_of_an_absent_feature_says_how_to_get_it() {
        assert_eq!(
            said("sim", &["paper"]),
            "`lizard sim` is missing: this program was built without the simulator; make cli builds all"
        );
        assert!(said("backup", &[]).contains("without the commands for a board on USB;"));
        assert!(said("parts", &["console"]).contains("without the parts to print;"));
        assert!(said("monitor", &[]).starts_with("`lizard console` is missing: "));
    }

    #[test]
    fn of_two_features_those_that_are_absent_are_named() {
        assert!(said("tune", &["simulator"]).contains("without the commands that compute;"));
        assert!(said("tune", &["paper"]).contains("without the simulator;"));
        assert!(said("replay", &[]).contains("a board on USB and the simulator;"));
    }

    #[test]
    fn a_word_that_is_no_command_is_answered_with_the_one_that_was_meant() {
        assert_eq!(
            said("fly", &[]),
            "there is no command `fly`; lizard --help lists them"
        );
        assert!(said("claibrate", &[]).contains("; did you mean `calibrate`?"));
    }
}
