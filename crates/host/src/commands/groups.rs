//! The list of commands, grouped by purpose.
//!
//! A robot's owner needs five commands, which would be lost in one long list. `lizard help` therefore groups the
//! commands under headings, and prints only the names of the commands for scripts and development.

use std::fmt::Write as _;

use clap::Command;

use super::absent;
use super::command_entry::{CommandEntry, CommandGroup};

/// Returns `command` with a help text that lists its subcommands in groups according to `known_commands`.
pub(super) fn group_in_help(command: Command, known_commands: &[CommandEntry]) -> Command {
    let list = list_commands(&command, known_commands);
    let absent_note = absent::list_absent(known_commands);
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{list}{absent_note}`lizard help COMMAND` explains one of them.\n\n{}\n{{options}}{{after-help}}",
        format_heading("Options")
    ))
}

fn format_heading(text: &str) -> String {
    let style = *clap::builder::Styles::styled().get_header();
    format!("{style}{text}:{style:#}")
}

/// Lists every subcommand once, under the heading of its group.
fn list_commands(command: &Command, known_commands: &[CommandEntry]) -> String {
    let subcommands: Vec<&Command> = command.get_subcommands().collect();
    let max_name_length = subcommands.iter().map(|sub| sub.get_name().len()).max();
    let width = max_name_length.unwrap_or(0);
    let mut text = String::new();
    let write_section = |text: &mut String, title: &str, listed_subcommands: &[&Command]| {
        if listed_subcommands.is_empty() {
            return;
        }
        _ = writeln!(text, "{}", format_heading(title));
        for sub in listed_subcommands {
            let about = sub.get_about().map(ToString::to_string).unwrap_or_default();
            let aliases: Vec<&str> = sub.get_visible_aliases().collect();
            let format_note = |word: &str, names: &[&str]| match names.join(", ") {
                names if names.is_empty() => names,
                names => format!(" [{word}: {names}]"),
            };
            let nested_names: Vec<&str> = sub.get_subcommands().map(Command::get_name).collect();
            let notes = format_note("also", &aliases) + &format_note("with", &nested_names);
            // clap would read braces as placeholders of the template.
            let about = about.replace(['{', '}'], "");
            _ = writeln!(text, "  {:<width$}  {about}{notes}", sub.get_name());
        }
        text.push('\n');
    };
    for group in CommandGroup::ALL {
        let entries = known_commands.iter().filter(|entry| entry.group == group);
        let group_subcommands: Vec<&Command> = entries
            .filter_map(|entry| {
                let name = entry.name();
                subcommands
                    .iter()
                    .find(|sub| sub.get_name() == name)
                    .copied()
            })
            .collect();
        if group == CommandGroup::Development && !group_subcommands.is_empty() {
            let names: Vec<&str> = group_subcommands.iter().map(|sub| sub.get_name()).collect();
            _ = writeln!(
                text,
                "{}\n  {}\n",
                format_heading(group.title()),
                names.join(", ")
            );
        } else {
            write_section(&mut text, group.title(), &group_subcommands);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn list_commands_lists_every_command_once_in_group_order() {
        let subcommand = |name: &'static str| Command::new(name).about(format!("does {name}"));
        let command = Command::new("lizard").subcommands([
            subcommand("pose").visible_alias("fk"),
            subcommand("completions"),
            subcommand("console"),
        ]);
        let new_entry = |group, variant| CommandEntry {
            group,
            variant,
            aliases: &[],
            needed_features: &[],
        };
        let known = [
            new_entry(CommandGroup::Drive, "Console"),
            new_entry(CommandGroup::Paper, "Pose"),
            new_entry(CommandGroup::Development, "Completions"),
        ];
        assert_eq!(
            strip_colours(&list_commands(&command, &known)),
            "Drive the robot:\n  console      does console\n\n\
             The paper, computed:\n  pose         does pose [also: fk]\n\n\
             For scripts and development:\n  completions\n\n"
        );
    }

    /// Removes a terminal's colour codes.
    fn strip_colours(text: &str) -> String {
        let mut plain_text = String::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('\u{1b}') {
            plain_text.push_str(before);
            rest = after.split_once('m').map_or("", |(_, rest)| rest);
        }
        plain_text + rest
    }
}
