//! The table of the program's commands: each command's group in the help, its name, its
//! aliases, the cargo features it needs, its arguments and the function that runs it.
//!
//! A build without a feature lacks commands, and explains that when one of them is used.
//! So the table serves twice: as the enum of the commands of this build, and as the list
//! of all commands.

mod absent;
pub mod completions;
mod groups;
mod menu;

use std::ffi::OsString;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::Failure;
use crate::plain::readable_lines;
use groups::Group;

/// The table below, as [`Command`] and as [`KNOWN`].
macro_rules! commands {
    ($(
        $group:ident {
            $(
                $name:ident($arguments:ty) => $run:path
                $(, needs $($feature:literal)and+)?
                $(, also $alias:literal)?;
            )+
        }
    )+) => {
        /// The commands that this build has.
        #[derive(Subcommand)]
        pub enum Command {
            $($(
                $(#[cfg(all($(feature = $feature),+))])?
                $(#[command(visible_alias = $alias)])?
                #[allow(missing_docs, reason = "the help is that of the arguments")]
                $name($arguments),
            )+)+
            /// A command that this build may lack.
            #[cfg(not(all(
                feature = "simulator",
                feature = "paper",
                feature = "console",
                feature = "parts"
            )))]
            #[command(external_subcommand)]
            Other(Vec<OsString>),
        }

        impl Command {
            fn run(self) -> Result<(), Failure> {
                match self {
                    $($(
                        $(#[cfg(all($(feature = $feature),+))])?
                        Self::$name(arguments) => $run(arguments),
                    )+)+
                    #[cfg(not(all(
                        feature = "simulator",
                        feature = "paper",
                        feature = "console",
                        feature = "parts"
                    )))]
                    Self::Other(words) => Err(absent::explain(&words)),
                }
            }
        }

        /// All commands that there are, in the order of the help.
        const KNOWN: &[Known] = &[$($(
            Known {
                group: Group::$group,
                variant: stringify!($name),
                also: &[$($alias)?],
                needs: &[$($($feature),+)?],
            },
        )+)+];
    };
}

commands! {
    Drive {
        Flash(crate::flash::Args) => crate::flash::run, needs "console";
        Image(crate::image::Args) => crate::image::run, needs "console";
        Console(crate::console::interactive::ConsoleArgs) => crate::console::interactive::console, needs "console", also "monitor";
        Calibrate(crate::console::calibrate::Args) => crate::console::calibrate::run, needs "console";
        Backup(crate::console::backup::BackupArgs) => crate::console::backup::backup, needs "console";
        Restore(crate::console::backup::RestoreArgs) => crate::console::backup::restore, needs "console";
        Replay(crate::console::replay::Args) => crate::console::replay::run, needs "console" and "simulator";
    }
    Simulate {
        Sim(crate::sim::Args) => crate::sim::run, needs "simulator";
        Twin(crate::twin::Args) => crate::twin::run, needs "simulator";
        Mjcf(crate::mjcf::Args) => crate::mjcf::run, needs "simulator" and "parts";
    }
    Build {
        Draw(crate::draw::Args) => crate::draw::run;
        Parts(crate::parts::Args) => crate::parts::run, needs "parts";
        Fit(crate::parts::fit::Args) => crate::parts::fit::run, needs "parts";
    }
    Change {
        Gaits(crate::gaits::Args) => crate::gaits::run;
        Tune(crate::tune::Args) => crate::tune::run, needs "simulator" and "paper";
        Prove(crate::prove::Args) => crate::prove::run, needs "paper";
    }
    Paper {
        Pose(crate::paper::pose::Args) => crate::paper::pose::run, needs "paper";
        Design(crate::paper::design::Args) => crate::paper::design::run, needs "paper";
        Charts(crate::paper::charts::Args) => crate::paper::charts::run, needs "paper";
        Errata(crate::paper::errata::Args) => crate::paper::errata::run, needs "paper";
    }
    Itself {
        Merge(crate::merge::MergeArgs) => crate::merge::merge;
        Completions(completions::CompletionsArgs) => completions::completions;
        Man(completions::ManArgs) => completions::man;
        Bench(crate::bench::Args) => crate::bench::run, needs "simulator";
    }
}

/// Commands of the version before, and the words that mean the same now.
const RENAMED: [(&str, &[&str]); 9] = [
    ("solve", &["pose"]),
    ("fk", &["pose"]),
    ("inverse", &["pose"]),
    ("ik", &["pose"]),
    ("velocity", &["pose", "--show", "rates"]),
    ("jacobian", &["pose", "--show", "rates"]),
    ("singularity", &["pose", "--show", "singularities"]),
    ("mobility", &["pose", "--show", "freedoms"]),
    ("record", &["console", "--record"]),
];

/// Commands of the version before that are gone.
const REMOVED: [(&str, &str); 2] = [
    (
        "spring",
        "a spring's force and rate belong into robot.toml, under [leg.drive], or its coil under \
         [parts.spring]",
    ),
    ("speed", "make bench measures how fast poses are solved"),
];

/// The command line with the words of this version for those of the one before.
///
/// # Errors
/// The command is gone.
fn in_new_words(mut words: Vec<OsString>) -> Result<Vec<OsString>, Failure> {
    let Some(word) = words.get(1).and_then(|word| word.to_str()) else {
        return Ok(words);
    };
    if let Some((word, instead)) = REMOVED.iter().find(|(old, _)| *old == word) {
        return Err(Failure::Input(format!(
            "there is no command `{word}` any more; {instead}"
        )));
    }
    if let Some((old, new)) = RENAMED.iter().find(|(old, _)| *old == word) {
        eprintln!(
            "lizard: `{old}` is `lizard {}` now; the next version will not know the old word",
            new.join(" ")
        );
        words.splice(1..2, new.iter().map(OsString::from));
    }
    Ok(words)
}

/// A command that there is, in this build or in another one.
#[derive(Debug, Clone, Copy)]
struct Known {
    group: Group,
    /// The enum's name of it.
    variant: &'static str,
    /// Words that mean the same.
    also: &'static [&'static str],
    /// The cargo features without which it is not built.
    needs: &'static [&'static str],
}

impl Known {
    /// As it is typed.
    fn name(&self) -> String {
        self.variant.to_lowercase()
    }
}

/// Compute, check, draw and simulate the four-servo robotic lizard.
///
/// Angles are degrees in the chassis frame: x to the robot's right, y forward,
/// counter-clockwise from +x, seen from above. Lengths are mm. Servos are A1 =
/// theta1 (front left), A2 = theta4 (front right), A3 = theta8 (back right), A4 =
/// theta5 (back left).
///
/// Exit codes: 0 done, 1 it could not be done, 2 the input is wrong.
#[derive(Parser)]
#[command(name = "lizard", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// All commands and options, the commands in groups.
#[must_use]
pub fn program() -> clap::Command {
    groups::grouped(Cli::command())
}

/// Does what the command line asks for; without a command, what is chosen from a menu where
/// standard input is a terminal.
///
/// # Errors
/// Those of the command.
pub fn run(words: Vec<OsString>) -> Result<(), Failure> {
    let words = match menu::chosen(&words)? {
        menu::Choice::Typed => words,
        menu::Choice::Chosen(words) => words,
        menu::Choice::Nothing => return Ok(()),
    };
    let parsed = program().try_get_matches_from(in_new_words(words)?);
    match parsed.and_then(|mut matches| Cli::from_arg_matches_mut(&mut matches)) {
        Ok(cli) => cli.command.run(),
        Err(error) => leave(&error),
    }
}

/// Ends the program with what clap says: the help, or a mistake, of which a word that is very
/// long is shortened.
fn leave(error: &clap::Error) -> ! {
    let text = error.render().to_string();
    let short = readable_lines(&text);
    if short == text {
        error.exit();
    }
    eprint!("{short}");
    std::process::exit(error.exit_code())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    #[cfg(all(
        feature = "simulator",
        feature = "paper",
        feature = "console",
        feature = "parts"
    ))]
    fn a_whole_build_has_every_command_by_its_name_and_its_other_words() {
        let program = Cli::command();
        let built: BTreeSet<String> = program
            .get_subcommands()
            .flat_map(|sub| std::iter::once(sub.get_name()).chain(sub.get_visible_aliases()))
            .map(str::to_owned)
            .collect();
        let known: BTreeSet<String> = KNOWN
            .iter()
            .flat_map(|known| {
                let also = known.also.iter().map(ToString::to_string);
                std::iter::once(known.name()).chain(also)
            })
            .collect();
        assert_eq!(built, known);
        assert!(
            known.contains("monitor") && known.contains("merge"),
            "{known:?}"
        );
    }

    #[test]
    fn an_old_word_means_a_command_that_there_is_and_no_new_one_is_lost() {
        for (old, new) in RENAMED {
            let [old, name] =
                [old, new[0]].map(|word| KNOWN.iter().any(|known| known.name() == word));
            assert_eq!((old, name), (false, true), "{new:?}");
        }
        let words = |line: &str| line.split(' ').map(OsString::from).collect::<Vec<_>>();
        for (old, new) in [
            (
                "lizard velocity --omega1 5",
                "lizard pose --show rates --omega1 5",
            ),
            (
                "lizard record a.jsonl --sim",
                "lizard console --record a.jsonl --sim",
            ),
            ("lizard console solve", "lizard console solve"),
        ] {
            assert_eq!(in_new_words(words(old)).expect("it is known"), words(new));
        }
        let gone = in_new_words(words("lizard spring --wire 0.6")).expect_err("it is gone");
        assert!(gone.to_string().contains("[leg.drive]"), "{gone}");
    }

    #[test]
    fn every_feature_that_a_command_needs_has_words() {
        for known in KNOWN {
            for feature in known.needs {
                assert_ne!(absent::words(feature), "", "{known:?}");
            }
        }
    }
}
