//! The table of the program's commands. A row has a command's name, arguments, function, cargo features and alias. The
//! rows are grouped as in the help; the groups for owners of a robot come first.
//!
//! A build without a cargo feature reports its missing commands by name. The table therefore defines both the enum of
//! this build's commands and the list of all commands.

mod absent;
mod command_entry;
pub mod completions;
mod groups;
pub mod merge;
mod nested;

use std::ffi::OsString;
use std::io::{self, Write};

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::Failure;
use crate::shared::escape::make_readable;
use command_entry::{CommandEntry, DEVELOPMENT};
use nested::WithSubcommand;

/// Defines [`Command`] and [`KNOWN_COMMANDS`] from the table below.
macro_rules! commands {
    ($(
        $group:expr => {
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
                #[allow(missing_docs, reason = "the help text is in the arguments")]
                $name($arguments),
            )+)+
            /// The words of a command line whose command is unknown or missing from this build.
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
                    Self::Other(words) => Err(absent::explain_absence(&words, KNOWN_COMMANDS, absent::is_in_build)),
                }
            }
        }

        /// All commands in the order of the help, including those missing from this build.
        const KNOWN_COMMANDS: &[CommandEntry] = &[$($(
            CommandEntry {
                group: $group,
                variant: stringify!($name),
                aliases: &[$($alias)?],
                needed_features: &[$($($feature),+)?],
            },
        )+)+];
    };
}

commands! {
    "Drive the robot" => {
        Flash(WithSubcommand<crate::drive::flash::Args, nested::FlashSubcommand>) => nested::run_flash, needs "console";
        Info(WithSubcommand<crate::drive::console::info::Args, nested::InfoSubcommand>) => nested::run_info, needs "console";
        Console(WithSubcommand<crate::drive::console::interactive::ConsoleArgs, nested::ConsoleSubcommand>) => nested::run_console, needs "console", also "monitor";
        Calibrate(WithSubcommand<crate::drive::console::calibrate::Args, nested::CalibrateSubcommand>) => nested::run_calibrate, needs "console";
        Measure(WithSubcommand<crate::measure::Args, nested::MeasureSubcommand>) => nested::run_measure, needs "parts";
    }
    "Simulate it" => {
        Sim(WithSubcommand<crate::simulate::sim::Args, nested::SimSubcommand>) => nested::run_sim, needs "simulator";
        Twin(crate::simulate::twin::Args) => crate::simulate::twin::run, needs "simulator";
        Model(crate::make::model::Args) => crate::make::model::run, needs "parts", also "mjcf";
    }
    "Build it" => {
        Draw(WithSubcommand<crate::make::draw::Args, nested::DrawSubcommand>) => nested::run_draw;
        Parts(crate::make::parts::Args) => crate::make::parts::run, needs "parts";
        Fit(crate::make::parts::fit::Args) => crate::make::parts::fit::run, needs "parts";
    }
    "Change its gaits and dimensions" => {
        New(crate::change::new::Args) => crate::change::new::run;
        Gaits(crate::change::gaits::Args) => crate::change::gaits::run;
        Tune(crate::change::tune::Args) => crate::change::tune::run, needs "simulator" and "paper";
        Prove(crate::change::prove::Args) => crate::change::prove::run, needs "paper";
    }
    "The paper, computed" => {
        Pose(crate::paper::pose::Args) => crate::paper::pose::run, needs "paper";
        Design(crate::paper::design::Args) => crate::paper::design::run, needs "paper";
        Errata(crate::paper::errata::Args) => crate::paper::errata::run, needs "paper";
    }
    DEVELOPMENT => {
        Merge(merge::MergeArgs) => merge::merge;
        Completions(WithSubcommand<completions::CompletionsArgs, nested::CompletionsSubcommand>) => run_completions;
    }
}

/// Commands of the previous version, each with the words that replace the command.
const RENAMED_COMMANDS: [(&str, &[&str]); 17] = [
    ("solve", &["pose"]),
    ("fk", &["pose"]),
    ("inverse", &["pose"]),
    ("ik", &["pose"]),
    ("velocity", &["pose", "--show", "rates"]),
    ("jacobian", &["pose", "--show", "rates"]),
    ("singularity", &["pose", "--show", "singularities"]),
    ("mobility", &["pose", "--show", "freedoms"]),
    ("record", &["console", "--record"]),
    ("replay", &["console", "replay"]),
    ("ports", &["info", "ports"]),
    ("image", &["flash", "image"]),
    ("backup", &["calibrate", "backup"]),
    ("restore", &["calibrate", "restore"]),
    ("charts", &["draw", "charts"]),
    ("bench", &["sim", "bench"]),
    ("man", &["completions", "man"]),
];

/// Commands of the previous version that were removed, each with advice.
const REMOVED_COMMANDS: [(&str, &str); 2] = [
    (
        "spring",
        "a spring's force and rate belong in robot.toml, under [leg.drive], or its coil under \
         [parts.spring]",
    ),
    ("speed", "`make bench` measures the speed of solving poses"),
];

/// Replaces a command of the previous version, and prints a warning that it is deprecated.
///
/// # Errors
/// Fails if the command was removed.
fn translate_old_arguments(mut arguments: Vec<OsString>) -> Result<Vec<OsString>, Failure> {
    let Some(word) = arguments.get(1).and_then(|word| word.to_str()) else {
        return Ok(arguments);
    };
    if let Some((word, advice)) = REMOVED_COMMANDS.iter().find(|(old, _)| *old == word) {
        let message = format!("the command `{word}` was removed; {advice}");
        return Err(Failure::Input(message));
    }
    if let Some((old, new)) = RENAMED_COMMANDS.iter().find(|(old, _)| *old == word) {
        let _ = writeln!(
            io::stderr(),
            "lizard: `{old}` is deprecated and will be removed in the next version; use `lizard {}`",
            new.join(" ")
        );
        arguments.splice(1..2, new.iter().map(OsString::from));
    }
    Ok(arguments)
}

fn run_completions(
    args: WithSubcommand<completions::CompletionsArgs, nested::CompletionsSubcommand>,
) -> Result<(), Failure> {
    nested::run_completions(args, program())
}

/// Compute, check, draw and simulate the four-servo robotic lizard.
///
/// Angles are degrees in the chassis frame: x to the robot's right, y forward,
/// counter-clockwise from +x, seen from above. Lengths are mm. Servos are A1 =
/// theta1 (front left), A2 = theta4 (front right), A3 = theta8 (back right), A4 =
/// theta5 (back left).
///
/// Exit codes: 0 success, 1 failure, 2 invalid input.
#[derive(Parser)]
#[command(name = "lizard", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// Returns the program's commands and options; the help lists the commands in groups.
pub fn program() -> clap::Command {
    let addresses = list_addresses(env!("CARGO_PKG_HOMEPAGE"), env!("CARGO_PKG_REPOSITORY"));
    groups::group_in_help(Cli::command().after_help(addresses), KNOWN_COMMANDS)
}

/// Lists the project's addresses that are not empty, one per line, for the end of the help.
fn list_addresses(page: &str, source: &str) -> String {
    let lines = [
        ("Page", page, ""),
        ("Source", source, ""),
        ("Report a bug", source, "/issues"),
    ];
    let present_lines = lines.iter().filter(|(_, address, _)| !address.is_empty());
    let lines = present_lines.map(|(name, address, path)| format!("{name}: {address}{path}\n"));
    lines.collect()
}

/// Runs a command line. Ends the program after clap has printed the help or refused the arguments.
///
/// # Errors
/// Returns the errors of the command.
pub fn run(arguments: Vec<OsString>) -> Result<(), Failure> {
    let parsed = program().try_get_matches_from(translate_old_arguments(arguments)?);
    match parsed.and_then(|mut matches| Cli::from_arg_matches_mut(&mut matches)) {
        Ok(cli) => cli.command.run(),
        Err(error) => exit_with(&error),
    }
}

/// Runs a command line, writes the message of its failure, and returns the exit code. Ends the program as [`run`] does.
pub fn run_and_report(arguments: Vec<OsString>) -> u8 {
    match run(arguments) {
        Ok(()) => 0,
        Err(failure) if failure.is_silent() => 0,
        Err(failure) => {
            // The message may quote a file or a board, so its control characters are escaped. `writeln` instead of
            // `eprintln`, because a closed terminal must not cause a panic.
            let message = make_readable(&failure.to_string());
            let _ = writeln!(io::stderr(), "lizard: {message}");
            failure.exit_code()
        }
    }
}

/// Prints clap's message, which is the help or an error, with control characters escaped and very long lines
/// shortened, and ends the program.
fn exit_with(error: &clap::Error) -> ! {
    let text = error.render().to_string();
    let shortened_text = make_readable(&text);
    if shortened_text == text {
        error.exit();
    }
    let _ = write!(io::stderr(), "{shortened_text}");
    std::process::exit(error.exit_code())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// Tests of a build with every feature.
    #[cfg(all(
        feature = "simulator",
        feature = "paper",
        feature = "console",
        feature = "parts"
    ))]
    mod complete {
        use super::*;

        #[test]
        fn a_complete_build_has_exactly_the_known_names_and_aliases() {
            let program = Cli::command();
            let built_names: BTreeSet<String> = program
                .get_subcommands()
                .flat_map(|sub| std::iter::once(sub.get_name()).chain(sub.get_visible_aliases()))
                .map(str::to_owned)
                .collect();
            let known_names: BTreeSet<String> = KNOWN_COMMANDS
                .iter()
                .flat_map(|entry| {
                    let aliases = entry.aliases.iter().map(ToString::to_string);
                    std::iter::once(entry.name()).chain(aliases)
                })
                .collect();
            assert_eq!(built_names, known_names);
            for name in ["monitor", "merge"] {
                assert!(known_names.contains(name), "{known_names:?}");
            }
        }

        #[test]
        fn the_docs_list_exactly_the_commands_without_json() {
            let page = include_str!("../../../../docs/commands.md");
            let list = page.split_once("`--json`, except ");
            let (_, list) = list.expect("the page has the list");
            let (list, _) = list.split_once(':').expect("the list has an end");
            // Every second piece is between backticks.
            let named_commands: BTreeSet<&str> = list.split('`').skip(1).step_by(2).collect();
            let program = Cli::command();
            let has_json =
                |sub: &&clap::Command| sub.get_arguments().any(|arg| arg.get_id() == "json");
            let commands_without_json = program.get_subcommands().filter(|sub| !has_json(sub));
            let names = commands_without_json.map(clap::Command::get_name);
            assert_eq!(names.collect::<BTreeSet<_>>(), named_commands);
        }
    }

    #[test]
    fn old_commands_lead_to_an_existing_command_or_to_advice() {
        let is_known = |word: &str| KNOWN_COMMANDS.iter().any(|entry| entry.name() == word);
        for (old, new) in RENAMED_COMMANDS {
            assert!(!is_known(old), "{old}");
            assert!(is_known(new[0]), "{new:?}");
        }
        let split_words = |line: &str| line.split(' ').map(OsString::from).collect::<Vec<_>>();
        for (old, new) in [
            ("velocity --omega1 5", "pose --show rates --omega1 5"),
            ("record a.jsonl --sim", "console --record a.jsonl --sim"),
            ("console solve", "console solve"),
        ] {
            let [old, new] = [old, new].map(|line| split_words(&format!("lizard {line}")));
            let translated = translate_old_arguments(old).expect("the command was not removed");
            assert_eq!(translated, new);
        }
        let result = translate_old_arguments(split_words("lizard spring --wire 0.6"));
        let error = result.expect_err("the command was removed");
        assert!(error.to_string().contains("[leg.drive]"), "{error}");
    }

    #[test]
    fn the_help_lists_only_addresses_that_are_not_empty() {
        let source_lines =
            "Source: https://s.example/l\nReport a bug: https://s.example/l/issues\n";
        for (page, source, lines) in [
            ("", "", ""),
            ("https://p.example", "", "Page: https://p.example\n"),
            ("", "https://s.example/l", source_lines),
        ] {
            assert_eq!(list_addresses(page, source), lines, "{page} {source}");
        }
    }

    #[test]
    fn every_needed_feature_has_a_description() {
        for entry in KNOWN_COMMANDS {
            for feature in entry.needed_features {
                let description = absent::describe_features(|name| name == *feature);
                assert_ne!(description, "", "{entry:?}");
            }
        }
    }
}
