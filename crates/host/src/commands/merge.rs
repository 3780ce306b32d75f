//! `lizard merge`: joins the parts of a long computation.

use std::io::{self, IsTerminal};
use std::path::PathBuf;

use crate::Failure;
use crate::shared::files;
use crate::shared::spread::{PartOutput, Spreadable, mismatched_parts_failure};

/// Join the parts of a long computation
///
/// `prove`, `fit`, `tune` and `design --search` take `--part K/N`. This command takes the
/// output of all N parts, in any order, and prints the same bytes as the command without
/// `--part`. The parts contain the robot and the options.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  parallel lizard prove --part {}/8 ::: 1 2 3 4 5 6 7 8 | lizard merge
  lizard fit --part $SLURM_ARRAY_TASK_ID/20 > part-$SLURM_ARRAY_TASK_ID
  lizard merge part-*")]
pub struct MergeArgs {
    /// Files with the output of one or more parts each [default: standard input]
    #[arg(value_name = "FILE")]
    paths: Vec<PathBuf>,
}

/// Reads all parts and runs the command with their results.
///
/// # Errors
/// Fails if a part is missing, is given twice or belongs to another computation, or if the command itself fails.
pub fn merge(args: MergeArgs) -> Result<(), Failure> {
    let joined = join_parts(read_all_parts(&args.paths)?)?;
    match joined.command.as_str() {
        #[cfg(feature = "paper")]
        "prove" => run_joined(joined, crate::change::prove::run),
        #[cfg(feature = "paper")]
        "design" => run_joined(joined, crate::paper::design::run),
        #[cfg(all(feature = "simulator", feature = "paper"))]
        "tune" => run_joined(joined, crate::change::tune::run),
        #[cfg(feature = "parts")]
        "fit" => run_joined(joined, crate::make::parts::fit::run),
        command => Err(Failure::Input(format!(
            "the parts are from `lizard {command}`, which is missing from this program"
        ))),
    }
}

/// Reads the parts from files, or from standard input unless it is a terminal.
fn read_all_parts(paths: &[PathBuf]) -> Result<Vec<PartOutput>, Failure> {
    let mut parts = Vec::new();
    if paths.is_empty() && !io::stdin().is_terminal() {
        let text = io::read_to_string(io::stdin())?;
        parse_parts("standard input", &text, &mut parts)?;
    }
    for path in paths {
        let text = files::read_text(path)?;
        parse_parts(&path.display().to_string(), &text, &mut parts)?;
    }
    Ok(parts)
}

/// Parses the text of one source, with a part in each line that is not blank, and appends the parts to `parts`.
fn parse_parts(name: &str, text: &str, parts: &mut Vec<PartOutput>) -> Result<(), Failure> {
    for (number, line) in (1..).zip(text.lines()) {
        if line.trim().is_empty() {
            continue;
        }
        let part = serde_json::from_str(line).map_err(|error| {
            Failure::Input(format!("{name}: line {number} is not a part: {error}"))
        })?;
        parts.push(part);
    }
    Ok(())
}

/// Joins the parts to one that has all results; fails unless they are all the parts of one computation.
fn join_parts(mut parts: Vec<PartOutput>) -> Result<PartOutput, Failure> {
    let refuse = |reason: String| Err(Failure::Input(reason));
    let Some(first) = parts.first() else {
        let reason = "no parts given; `lizard merge --help` shows how to compute them";
        return refuse(reason.to_owned());
    };
    let part_count = first.part.part_count;
    let mut is_given = vec![false; part_count as usize];
    for part in &parts {
        let name = String::from(part.part);
        let version = env!("CARGO_PKG_VERSION");
        if part.version != version {
            return refuse(format!(
                "part {name} is from version {}, but this is version {version}",
                part.version
            ));
        }
        if part.command != first.command {
            return refuse(format!(
                "part {name} is from `lizard {}`, but another part is from `lizard {}`",
                part.command, first.command
            ));
        }
        if part.options != first.options
            || part.part.part_count != part_count
            || part.piece_count != first.piece_count
        {
            let reason = format!("part {name} has different options from another part");
            return refuse(reason);
        }
        if part.robot != first.robot {
            let reason = format!("part {name} has a different robot from another part");
            return refuse(reason);
        }
        let index = part.part.number as usize - 1;
        if std::mem::replace(&mut is_given[index], true) {
            return refuse(format!("part {name} is given twice"));
        }
    }
    if let Some(missing) = is_given.iter().position(|is_given| !is_given) {
        return refuse(format!("part {}/{part_count} is missing", missing + 1));
    }
    let mut joined = parts.remove(0);
    joined
        .results
        .extend(parts.into_iter().flat_map(|part| part.results));
    Ok(joined)
}

/// Runs the command as on one machine, but takes the results from the parts instead of computing them.
#[cfg_attr(
    not(any(feature = "paper", feature = "parts")),
    allow(dead_code, reason = "this build has no command with parts")
)]
fn run_joined<C: Spreadable>(
    joined: PartOutput,
    run_command: impl FnOnce(C) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut command: C =
        serde_json::from_value(joined.options).map_err(|_| mismatched_parts_failure())?;
    command
        .spread_args()
        .set_merged(joined.robot, joined.results);
    run_command(command)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde_json::Value;

    use super::*;

    fn part_output(part: &str) -> PartOutput {
        PartOutput {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            command: "prove".to_owned(),
            options: Value::Null,
            robot: "one".to_owned(),
            part: part.parse().expect(part),
            piece_count: 4,
            results: BTreeMap::new(),
        }
    }

    fn refusal_message(parts: Vec<PartOutput>) -> String {
        let failure = join_parts(parts).err();
        failure.expect("the parts must be refused").to_string()
    }

    #[test]
    fn missing_duplicate_and_unrelated_parts_are_refused() {
        let message_after = |change: fn(&mut PartOutput)| {
            let mut second = part_output("2/2");
            change(&mut second);
            refusal_message(vec![part_output("1/2"), second])
        };
        let missing_part = vec![part_output("1/2")];
        assert_eq!(refusal_message(missing_part), "part 2/2 is missing");
        let duplicate_part = ["1/2", "1/2", "2/2"].map(part_output).into();
        assert_eq!(refusal_message(duplicate_part), "part 1/2 is given twice");
        let message = message_after(|part| part.robot = "other".to_owned());
        assert_eq!(message, "part 2/2 has a different robot from another part");
        let message = message_after(|part| part.options = Value::Bool(true));
        assert_eq!(message, "part 2/2 has different options from another part");
        assert_eq!(
            message_after(|part| part.command = "fit".to_owned()),
            "part 2/2 is from `lizard fit`, but another part is from `lizard prove`"
        );
        let message = message_after(|part| part.version = "0.0.1".to_owned());
        assert!(message.contains("is from version 0.0.1"), "{message}");
        assert!(refusal_message(Vec::new()).starts_with("no parts given"));
        // Parts are accepted in any order.
        assert!(join_parts(["2/2", "1/2"].map(part_output).into()).is_ok());
    }
}
