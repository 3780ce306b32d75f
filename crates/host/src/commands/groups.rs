//! The list of commands, grouped by purpose.
//!
//! Many commands in one list hide the five that the owner of a robot needs. So `lizard
//! help` has them under headings, and those that people do not type are only named.

use std::fmt::Write as _;

use clap::Command;

use super::KNOWN;

/// What a command is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Group {
    /// A robot that is there.
    Drive,
    /// The firmware on a simulated board.
    Simulate,
    /// Parts and pictures.
    Build,
    /// What robot.toml says.
    Change,
    /// What the paper has.
    Paper,
    /// Scripts and development.
    Itself,
}

/// All groups in the order of the help, the owner's first.
const GROUPS: [Group; 6] = [
    Group::Drive,
    Group::Simulate,
    Group::Build,
    Group::Change,
    Group::Paper,
    Group::Itself,
];

impl Group {
    fn title(self) -> &'static str {
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

/// The command with its subcommands in groups in its help.
pub(super) fn grouped(command: Command) -> Command {
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
    let present: Vec<&Command> = command.get_subcommands().collect();
    let widest = present.iter().map(|sub| sub.get_name().len()).max();
    let width = widest.unwrap_or(0);
    let mut text = String::new();
    let section = |text: &mut String, title: &str, subs: &[&Command]| {
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
    for group in GROUPS {
        let names = KNOWN.iter().filter(|known| known.group == group);
        let subs: Vec<&Command> = names
            .filter_map(|known| {
                let name = known.name();
                present.iter().find(|sub| sub.get_name() == name).copied()
            })
            .collect();
        if group == Group::Itself && !subs.is_empty() {
            let names: Vec<&str> = subs.iter().map(|sub| sub.get_name()).collect();
            _ = writeln!(text, "{}\n  {}\n", heading(group.title()), names.join(", "));
        } else {
            section(&mut text, group.title(), &subs);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_is_listed_once_and_the_owners_come_first() {
        let sub = |name: &'static str| Command::new(name).about(format!("does {name}"));
        let command = Command::new("lizard").subcommands([
            sub("pose").visible_alias("fk"),
            sub("completions"),
            sub("console"),
        ]);
        assert_eq!(
            without_colours(&list(&command)),
            "Drive the robot:\n  console      does console\n\n\
             The paper, computed:\n  pose         does pose [also: fk]\n\n\
             For scripts and development:\n  completions\n\n"
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
