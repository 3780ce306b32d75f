//! The list of commands by what they are for.
//!
//! Thirty commands in one list hide the five that the owner of a robot needs. So `lizard
//! help` has them under headings, the owner's first.

use std::fmt::Write as _;

use clap::Command;

/// The headings and what is under them, in their order. A build without a feature lacks some.
const GROUPS: [(&str, &[&str]); 5] = [
    (
        "Drive the robot",
        &[
            "flash",
            "console",
            "calibrate",
            "backup",
            "restore",
            "record",
            "replay",
        ],
    ),
    ("Simulate it", &["sim", "twin", "mjcf", "bench"]),
    ("Build it", &["draw", "parts", "fit", "spring"]),
    ("Change its gaits and measures", &["gaits", "tune", "prove"]),
    (
        "The paper, computed",
        &[
            "solve",
            "inverse",
            "velocity",
            "singularity",
            "mobility",
            "design",
            "charts",
            "errata",
            "speed",
        ],
    ),
];
/// What is in no group.
const REST: &str = "The program itself";

/// The command with its subcommands in groups in its help.
#[must_use]
pub fn grouped(command: Command) -> Command {
    let list = list(&command);
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{list}`lizard help COMMAND` says all about one of them.\n\n{}\n{{options}}{{after-help}}",
        heading("Options")
    ))
}

fn heading(words: &str) -> String {
    let style = *clap::builder::Styles::styled().get_header();
    format!("{style}{words}:{style:#}")
}

/// Every subcommand once, under its heading.
fn list(command: &Command) -> String {
    let present: Vec<&Command> = command
        .get_subcommands()
        .filter(|sub| !sub.is_hide_set())
        .collect();
    let widest = present.iter().map(|sub| sub.get_name().len()).max();
    let width = widest.unwrap_or(0);
    let mut text = String::new();
    let mut section = |title: &str, subs: &[&Command]| {
        if subs.is_empty() {
            return;
        }
        _ = writeln!(text, "{}", heading(title));
        for sub in subs {
            let about = sub.get_about().map(ToString::to_string).unwrap_or_default();
            let aliases: Vec<&str> = sub.get_visible_aliases().collect();
            let also = match aliases.join(", ") {
                names if names.is_empty() => names,
                names => format!(" [also: {names}]"),
            };
            // The template's own marks are in braces.
            let about = about.replace(['{', '}'], "");
            _ = writeln!(text, "  {:<width$}  {about}{also}", sub.get_name());
        }
        text.push('\n');
    };
    for (title, names) in GROUPS {
        let subs: Vec<&Command> = names
            .iter()
            .filter_map(|name| present.iter().find(|sub| sub.get_name() == *name).copied())
            .collect();
        section(title, &subs);
    }
    let is_grouped = |name: &str| GROUPS.iter().any(|(_, names)| names.contains(&name));
    let rest: Vec<&Command> = present
        .iter()
        .copied()
        .filter(|sub| !is_grouped(sub.get_name()))
        .collect();
    section(REST, &rest);
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_is_listed_once_and_the_owners_come_first() {
        let sub = |name: &'static str| Command::new(name).about(format!("does {name}"));
        let command = Command::new("lizard").subcommands([
            sub("solve").visible_alias("fk"),
            sub("completions"),
            sub("console"),
            sub("secret").hide(true),
        ]);
        assert_eq!(
            without_colours(&list(&command)),
            "Drive the robot:\n  console      does console\n\n\
             The paper, computed:\n  solve        does solve [also: fk]\n\n\
             The program itself:\n  completions  does completions\n\n"
        );
    }

    /// The text without the colours of a terminal.
    fn without_colours(text: &str) -> String {
        let mut plain = String::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('\u{1b}') {
            plain.push_str(before);
            rest = after.split_once('m').map_or("", |(_, rest)| rest);
        }
        plain + rest
    }
}
