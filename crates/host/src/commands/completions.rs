//! `lizard completions`: shell completions; `lizard completions man`: manual pages.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Command;
use clap_complete::Shell;

use crate::Failure;
use crate::shared::{files, robot_args};

/// Print a shell's completion script
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard completions bash > ~/.local/share/bash-completion/completions/lizard
  lizard completions zsh > ~/.zfunc/_lizard
  lizard completions fish > ~/.config/fish/completions/lizard.fish")]
pub struct CompletionsArgs {
    // Optional for Rust, because the subcommand `man` has no shell.
    /// The shell
    #[arg(required = true)]
    shell: Option<Shell>,
}

/// Write a manual page for each command into a folder
#[derive(clap::Args, Debug)]
#[command(after_help = "Example:
  lizard completions man ~/.local/share/man/man1 && man lizard-console")]
pub struct ManArgs {
    /// The folder; it is created if it does not exist
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Runs `lizard completions`: prints a shell's completion script for `program`.
///
/// # Errors
/// Fails if standard output cannot be written.
pub fn print_completions(args: CompletionsArgs, mut program: Command) -> Result<(), Failure> {
    let shell = args.shell.expect("clap requires a shell");
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut program, "lizard", &mut script);
    let script = String::from_utf8_lossy(&script);
    let mut out = io::stdout().lock();
    out.write_all(narrow_robot_suggestions(&script).as_bytes())?;
    Ok(out.flush()?)
}

/// Narrows a completion script's file suggestions for `--robot` to .toml files, since clap itself can only suggest all
/// files. For bash and fish, also adds the names of the built-in robots.
fn narrow_robot_suggestions(script: &str) -> String {
    const BASH_FILE_LINE: &str = "COMPREPLY=($(compgen -f \"${cur}\"))";
    let names = robot_args::built_in_names().join(" ");
    let bash_robot_line = format!(
        "COMPREPLY=($(compgen -W '{names}' -- \"${{cur}}\") $(compgen -f -X '!*.toml' -- \
         \"${{cur}}\") $(compgen -d -S / -- \"${{cur}}\"))"
    );
    let mut is_after_robot = false;
    let lines = script.lines().map(|line| {
        let narrowed_line = match line.trim_start() {
            // The three arms are for bash (the line after `--robot)`), zsh and fish.
            trimmed if is_after_robot && trimmed == BASH_FILE_LINE => {
                line.replace(BASH_FILE_LINE, &bash_robot_line)
            }
            trimmed if trimmed.starts_with("'--robot=") => {
                line.replace(":_files'", ":_files -g \"*.toml\"'")
            }
            trimmed if trimmed.contains(" -l robot ") && trimmed.ends_with(" -r -F") => {
                let option = line.trim_end_matches(" -F");
                format!("{option} -k -xa \"(__fish_complete_suffix .toml) {names}\"")
            }
            _ => line.to_owned(),
        };
        is_after_robot = line.trim() == "--robot)";
        narrowed_line + "\n"
    });
    lines.collect()
}

/// Runs `lizard completions man`: writes the manual pages of `program` and its commands.
///
/// # Errors
/// Fails if a file cannot be written.
pub fn write_manual_pages(args: ManArgs, program: Command) -> Result<(), Failure> {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let mut pages = vec![("lizard".to_owned(), &program)];
    for command in program.get_subcommands() {
        let name = format!("lizard-{}", command.get_name());
        for nested in command.get_subcommands() {
            pages.push((format!("{name}-{}", nested.get_name()), nested));
        }
        pages.push((name, command));
    }
    for (name, command) in &pages {
        let mut text = Vec::new();
        clap_mangen::Man::new((*command).clone()).render(&mut text)?;
        files::write(&args.folder.join(format!("{name}.1")), &text)?;
    }
    let (page_count, folder) = (pages.len(), args.folder.display());
    writeln!(io::stdout(), "wrote {page_count} manual pages to {folder}")?;
    Ok(())
}
