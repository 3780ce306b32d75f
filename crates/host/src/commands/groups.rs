//! The list of commands, grouped by purpose.
//!
//! A robot's owner needs five commands, which would be lost in one long list. `lizard help` therefore groups the
//! commands under headings, and prints only the names of the commands for scripts and development.

use std::fmt::Write as _;

use clap::Command;

use super::absent;
use super::command_entry::{CommandEntry, DEVELOPMENT};

/// Returns `command` with a help text that lists its subcommands in groups according to `known_commands`.
pub(super) fn group_in_help(command: Command, known_commands: &[CommandEntry]) -> Command {
    let list = list_commands(&command, known_commands);
    let absent_note = absent::list_absent(known_commands, absent::is_in_build);
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
    let name_lengths = command.get_subcommands().map(|sub| sub.get_name().len());
    let width = name_lengths.max().unwrap_or(0);
    let mut text = String::new();
    for entries in known_commands.chunk_by(|entry, next| entry.group == next.group) {
        let commands_in_build = entries
            .iter()
            .filter_map(|entry| command.find_subcommand(entry.name()));
        let commands_in_build: Vec<&Command> = commands_in_build.collect();
        if commands_in_build.is_empty() {
            continue;
        }
        let group = entries[0].group;
        _ = writeln!(text, "{}", format_heading(group));
        if group == DEVELOPMENT {
            let names: Vec<&str> = commands_in_build.iter().map(|sub| sub.get_name()).collect();
            _ = writeln!(text, "  {}", names.join(", "));
        } else {
            for sub in commands_in_build {
                text += &format_command(sub, width);
            }
        }
        text.push('\n');
    }
    text
}

/// Formats a subcommand's name, `width` columns wide, its description, and its other names and subcommands.
fn format_command(command: &Command, width: usize) -> String {
    let about = command.get_about().map(ToString::to_string);
    // clap would read braces as placeholders of the template.
    let about = about.unwrap_or_default().replace(['{', '}'], "");
    let aliases: Vec<&str> = command.get_visible_aliases().collect();
    let nested_names: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
    let format_note = |word: &str, names: &[&str]| match names.join(", ") {
        names if names.is_empty() => names,
        names => format!(" [{word}: {names}]"),
    };
    let notes = format_note("also", &aliases) + &format_note("with", &nested_names);
    format!("  {:<width$}  {about}{notes}\n", command.get_name())
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
            new_entry("Drive the robot", "Console"),
            new_entry("The paper, computed", "Pose"),
            new_entry(DEVELOPMENT, "Completions"),
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
