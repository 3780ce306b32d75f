//! Long computations spread over machines.
//!
//! `lizard prove --part 2/8` computes an eighth and prints what it has found as one line;
//! `lizard merge` takes all eight and prints the same bytes as one machine. This holds by
//! construction: a computation is a list of pieces that do not depend on each other. One
//! machine computes them all, a part computes its own pieces, and a merge runs the same
//! program with the pieces that it has read. A part contains the version, the options and
//! the robot, so that parts of different computations cannot be mixed.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::path::PathBuf;
use std::str::FromStr;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::{Failure, RobotFile, files, json};

/// The most parts; more than any queue has use for.
const MOST: u32 = 1_000_000;

/// One of several parts of a computation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Part {
    /// From 1 on.
    number: u32,
    /// How many there are.
    of: u32,
}

impl FromStr for Part {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("it must be as 2/8, from 1/8 to 8/8, of at most {MOST}");
        let (number, of) = text.split_once('/').ok_or_else(wrong)?;
        let (Ok(number), Ok(of)) = (number.parse(), of.parse()) else {
            return Err(wrong());
        };
        if (1..=MOST).contains(&of) && (1..=of).contains(&number) {
            Ok(Self { number, of })
        } else {
            Err(wrong())
        }
    }
}

impl TryFrom<String> for Part {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Part> for String {
    fn from(part: Part) -> Self {
        format!("{}/{}", part.number, part.of)
    }
}

impl Part {
    /// Whether a piece is this part's. Pieces in a row go to different parts, for what takes
    /// long often has neighbours that do, too.
    fn has(self, piece: usize) -> bool {
        piece % self.of as usize == self.number as usize - 1
    }

    /// How many of this many pieces are this part's.
    #[must_use]
    pub fn count(self, pieces: usize) -> usize {
        (0..pieces).filter(|piece| self.has(*piece)).count()
    }

    /// Computes this part's pieces and prints them.
    ///
    /// # Errors
    /// The robot cannot be read, or the output not written.
    pub fn print<C: Spreads, T: Serialize>(
        self,
        command: &C,
        robot: &RobotFile,
        pieces: usize,
        mut one: impl FnMut(usize) -> T,
    ) -> Result<(), Failure> {
        let robot = robot.text()?;
        let mut found = BTreeMap::new();
        for place in (0..pieces).filter(|place| self.has(*place)) {
            found.insert(place, serde_json::to_value(one(place))?);
        }
        let share = Share {
            lizard: env!("CARGO_PKG_VERSION").to_owned(),
            command: C::COMMAND.to_owned(),
            options: serde_json::to_value(command)?,
            robot,
            part: self,
            pieces,
            found,
        };
        Ok(json::line(&mut io::stdout().lock(), &share)?)
    }
}

/// `--part`, and how a computation takes part in it.
#[derive(clap::Args, Debug, Default)]
pub struct Spread {
    /// Compute only one of N parts, and print it for `lizard merge`
    #[arg(long, value_name = "K/N", help_heading = "Spread over machines")]
    part: Option<Part>,
    /// What parts have found, where they are merged.
    #[arg(skip)]
    merged: Option<BTreeMap<usize, Value>>,
}

/// A command that can be spread: its options say all but the robot.
pub trait Spreads: Serialize + DeserializeOwned {
    /// The command's name.
    const COMMAND: &'static str;

    /// Its robot and its part.
    fn places(&mut self) -> (&mut RobotFile, &mut Spread);
}

/// What a part prints.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Share {
    /// The version of the program.
    lizard: String,
    command: String,
    options: Value,
    /// The text of robot.toml.
    robot: String,
    part: Part,
    /// How many pieces there are in all.
    pieces: usize,
    /// The pieces of this part, by their places.
    found: BTreeMap<usize, Value>,
}

impl Spread {
    /// The part that alone is computed, if one is.
    #[must_use]
    pub fn part(&self) -> Option<Part> {
        self.part
    }

    /// What parts have found, in its order, where they are merged.
    ///
    /// # Errors
    /// It is not what this computes.
    pub fn read<T: DeserializeOwned>(&self, count: usize) -> Result<Option<Vec<T>>, Failure> {
        let Some(merged) = &self.merged else {
            return Ok(None);
        };
        let values = merged.iter().zip(0..);
        if merged.len() != count || values.clone().any(|((place, _), at)| *place != at) {
            return Err(other_pieces());
        }
        let of = |((_, value), _): ((&usize, &Value), usize)| T::deserialize(value);
        let read: Result<Vec<T>, _> = values.map(of).collect();
        read.map(Some).map_err(|_| other_pieces())
    }

    /// All pieces in their order, each by `one` from its place: computed here, or read from
    /// parts. None where this is a part, which has been printed.
    ///
    /// # Errors
    /// The output cannot be written, or parts do not hold what this computes.
    pub fn all<T: Serialize + DeserializeOwned>(
        &self,
        command: &impl Spreads,
        robot: &RobotFile,
        count: usize,
        one: impl FnMut(usize) -> T,
    ) -> Result<Option<Vec<T>>, Failure> {
        if let Some(part) = self.part {
            return part.print(command, robot, count, one).map(|()| None);
        }
        let read = self.read(count)?;
        Ok(Some(read.unwrap_or_else(|| (0..count).map(one).collect())))
    }

    /// How many pieces of this many are computed here, for a bar.
    #[must_use]
    pub fn own(&self, count: usize) -> usize {
        match (&self.merged, self.part) {
            (Some(_), _) => 0,
            (None, None) => count,
            (None, Some(part)) => part.count(count),
        }
    }
}

fn other_pieces() -> Failure {
    Failure::Input("the parts do not hold what this computation finds".to_owned())
}

/// Put the parts of a long computation together
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
    /// Files with the output of the parts, one or more parts a file [default: standard
    /// input]
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
}

/// Reads all parts, and runs the command with what they have found.
///
/// # Errors
/// A part is missing, is there twice or differs from the others; and what the command says.
pub fn merge(args: MergeArgs) -> Result<(), Failure> {
    let whole = Whole::of(shares(&args.files)?)?;
    match whole.command.as_str() {
        #[cfg(feature = "paper")]
        "prove" => whole.run(crate::prove::run),
        #[cfg(feature = "paper")]
        "design" => whole.run(crate::paper::design::run),
        #[cfg(all(feature = "simulator", feature = "paper"))]
        "tune" => whole.run(crate::tune::run),
        #[cfg(feature = "parts")]
        "fit" => whole.run(crate::parts::fit::run),
        other => Err(Failure::Input(format!(
            "the parts are of `lizard {other}`, which this program does not have"
        ))),
    }
}

/// The parts in files, or in standard input.
fn shares(files: &[PathBuf]) -> Result<Vec<Share>, Failure> {
    let mut shares = Vec::new();
    let mut read = |name: &str, text: &str| {
        for (number, line) in (1..).zip(text.lines()) {
            if line.trim().is_empty() {
                continue;
            }
            let share = serde_json::from_str(line).map_err(|error| {
                Failure::Input(format!("{name}: line {number} is no part: {error}"))
            })?;
            shares.push(share);
        }
        Ok::<(), Failure>(())
    };
    if files.is_empty() {
        let mut text = String::new();
        io::stdin().lock().read_to_string(&mut text)?;
        read("standard input", &text)?;
    }
    for file in files {
        let name = file.display().to_string();
        let text = files::read_text(file)?;
        read(&name, &text)?;
    }
    Ok(shares)
}

/// All parts of one computation.
struct Whole {
    command: String,
    options: Value,
    robot: String,
    found: BTreeMap<usize, Value>,
}

impl Whole {
    /// The parts together, if they are all of one computation.
    fn of(shares: Vec<Share>) -> Result<Self, Failure> {
        let refused = |why: String| Err(Failure::Input(why));
        let Some(first) = shares.first() else {
            return refused(
                "there are no parts; `lizard merge --help` says how to make them".to_owned(),
            );
        };
        let (of, pieces) = (first.part.of, first.pieces);
        let mut whole = Self {
            command: first.command.clone(),
            options: first.options.clone(),
            robot: first.robot.clone(),
            found: BTreeMap::new(),
        };
        let mut seen = vec![false; of as usize];
        for share in shares {
            let name = String::from(share.part);
            let version = env!("CARGO_PKG_VERSION");
            if share.lizard != version {
                return refused(format!(
                    "part {name} is of version {}, and this is {version}",
                    share.lizard
                ));
            }
            if share.command != whole.command {
                return refused(format!(
                    "part {name} is of `lizard {}`, and another one is of `lizard {}`",
                    share.command, whole.command
                ));
            }
            if share.options != whole.options || share.part.of != of || share.pieces != pieces {
                return refused(format!("part {name} has other options than another part"));
            }
            if share.robot != whole.robot {
                return refused(format!("part {name} has another robot than another part"));
            }
            let place = share.part.number as usize - 1;
            if std::mem::replace(&mut seen[place], true) {
                return refused(format!("part {name} is there twice"));
            }
            whole.found.extend(share.found);
        }
        if let Some(missing) = seen.iter().position(|seen| !seen) {
            return refused(format!("part {}/{of} is missing", missing + 1));
        }
        Ok(whole)
    }

    /// The command as one machine runs it, with the pieces that were found.
    #[cfg_attr(
        not(any(feature = "paper", feature = "parts")),
        allow(dead_code, reason = "nothing can be spread")
    )]
    fn run<C: Spreads>(self, run: impl FnOnce(C) -> Result<(), Failure>) -> Result<(), Failure> {
        let mut command: C = serde_json::from_value(self.options).map_err(|_| other_pieces())?;
        let (robot, spread) = command.places();
        *robot = RobotFile::with_text(self.robot);
        spread.merged = Some(self.found);
        run(command)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn share(part: &str) -> Share {
        Share {
            lizard: env!("CARGO_PKG_VERSION").to_owned(),
            command: "prove".to_owned(),
            options: Value::Null,
            robot: "one".to_owned(),
            part: part.parse().expect(part),
            pieces: 4,
            found: BTreeMap::new(),
        }
    }

    fn refusal(shares: Vec<Share>) -> String {
        match Whole::of(shares) {
            Ok(_) => panic!("it is taken"),
            Err(failure) => failure.to_string(),
        }
    }

    #[test]
    fn every_piece_is_of_one_part() {
        for of in [1, 2, 3, 7, 40] {
            for piece in 0..20 {
                let parts = (1..=of).filter(|number| {
                    Part {
                        number: *number,
                        of,
                    }
                    .has(piece)
                });
                assert_eq!(parts.count(), 1, "piece {piece} of {of} parts");
            }
        }
    }

    #[test]
    fn a_part_is_written_as_two_numbers() {
        assert_eq!("2/8".parse(), Ok(Part { number: 2, of: 8 }));
        for wrong in [
            "",
            "2",
            "0/8",
            "9/8",
            "1/0",
            "-1/8",
            "1/8/8",
            "a/b",
            "1/1000001",
        ] {
            let said = wrong.parse::<Part>().expect_err(wrong);
            assert!(said.starts_with("it must be as 2/8"), "{wrong}: {said}");
        }
    }

    #[test]
    fn parts_that_are_not_of_one_computation_are_refused() {
        let changed = |change: fn(&mut Share)| {
            let mut second = share("2/2");
            change(&mut second);
            refusal(vec![share("1/2"), second])
        };
        assert_eq!(refusal(vec![share("1/2")]), "part 2/2 is missing");
        assert_eq!(
            refusal(vec![share("1/2"), share("1/2"), share("2/2")]),
            "part 1/2 is there twice"
        );
        assert_eq!(
            changed(|part| part.robot = "other".to_owned()),
            "part 2/2 has another robot than another part"
        );
        assert_eq!(
            changed(|part| part.options = Value::Bool(true)),
            "part 2/2 has other options than another part"
        );
        assert_eq!(
            changed(|part| part.command = "fit".to_owned()),
            "part 2/2 is of `lizard fit`, and another one is of `lizard prove`"
        );
        assert!(changed(|part| part.lizard = "0.0.1".to_owned()).contains("is of version 0.0.1"));
        assert!(refusal(Vec::new()).starts_with("there are no parts"));
        assert!(
            Whole::of(vec![share("2/2"), share("1/2")]).is_ok(),
            "in any order"
        );
    }
}
