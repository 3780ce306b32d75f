//! `lizard completions` and `lizard man`: what a shell and `man` know of the program.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Command;
use clap_complete::Shell;

use crate::Failure;
use crate::shared::files;

/// Print what a shell needs to complete commands and options
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard completions bash > ~/.local/share/bash-completion/completions/lizard
  lizard completions zsh > ~/.zfunc/_lizard
  lizard completions fish > ~/.config/fish/completions/lizard.fish")]
pub struct CompletionsArgs {
    /// The shell to print the completions for
    shell: Shell,
}

/// Write a manual page for each command into a folder
#[derive(clap::Args, Debug)]
#[command(after_help = "Example:
  lizard man ~/.local/share/man/man1 && man lizard-console")]
pub struct ManArgs {
    /// The folder; it is created if it does not exist
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Runs `lizard completions` for the whole program.
///
/// # Errors
/// Standard output cannot be written.
pub fn completions(args: CompletionsArgs, mut command: Command) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, "lizard", &mut script);
    let mut out = io::stdout().lock();
    out.write_all(&script)?;
    Ok(out.flush()?)
}

/// Runs `lizard man` for the whole program.
///
/// # Errors
/// A file cannot be written.
pub fn man(args: ManArgs, command: Command) -> Result<(), Failure> {
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let mut count = 1;
    page(&args, "lizard", command.clone())?;
    for sub in command.get_subcommands().filter(|sub| !sub.is_hide_set()) {
        let name = format!("lizard-{}", sub.get_name());
        page(&args, &name, sub.clone())?;
        count += 1;
    }
    let folder = args.folder.display();
    writeln!(io::stdout(), "{count} manual pages are in {folder}")?;
    Ok(())
}

fn page(args: &ManArgs, name: &str, command: Command) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_mangen::Man::new(command).render(&mut text)?;
    files::write(&args.folder.join(format!("{name}.1")), &text)
}
