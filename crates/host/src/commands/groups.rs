//! The list of commands, grouped by purpose.
//!
//! Many commands in one list hide the five that the owner of a robot needs. So `lizard help` puts them under
//! headings, and lists the commands for scripts by name only.

use std::fmt::Write as _;

use clap::Command;

use super::absent;
use super::known::{CommandEntry, Group};

/// Returns the command with a help text that lists its subcommands in groups.
pub(super) fn with_groups(command: Command, known: &[CommandEntry]) -> Command {
    let list = list(&command, known);
    let lacks = absent::list_absent(known);
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{list}{lacks}`lizard help COMMAND` explains one of them.\n\n{}\n{{options}}{{after-help}}",
        heading("Options")
    ))
}

fn heading(text: &str) -> String {
    let style = *clap::builder::Styles::styled().get_header();
    format!("{style}{text}:{style:#}")
}

/// Lists every subcommand once, under its heading.
fn list(command: &Command, known: &[CommandEntry]) -> String {
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
            let note = |word: &str, names: &[&str]| match names.join(", ") {
                names if names.is_empty() => names,
                names => format!(" [{word}: {names}]"),
            };
            let below: Vec<&str> = sub.get_subcommands().map(Command::get_name).collect();
            let also = note("also", &aliases) + &note("with", &below);
            // clap would read braces as placeholders of the template.
            let about = about.replace(['{', '}'], "");
            _ = writeln!(text, "  {:<width$}  {about}{also}", sub.get_name());
        }
        text.push('\n');
    };
    for group in Group::ALL {
        let names = known.iter().filter(|known| known.group == group);
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
        let row = |group, variant| CommandEntry {
            group,
            variant,
            aliases: &[],
            needs: &[],
        };
        let known = [
            row(Group::Drive, "Console"),
            row(Group::Paper, "Pose"),
            row(Group::Itself, "Completions"),
        ];
        assert_eq!(
            without_colours(&list(&command, &known)),
            "Drive the robot:\n  console      does console\n\n\
             The paper, computed:\n  pose         does pose [also: fk]\n\n\
             For scripts and development:\n  completions\n\n"
        );
    }

    /// Removes a terminal's colour codes.
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
