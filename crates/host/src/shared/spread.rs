//! Long computations spread over machines.
//!
//! `lizard prove --part 2/8` computes one of eight parts and prints its results as one line. `lizard merge` reads all
//! eight lines and prints the same bytes as a single machine, because a computation is a list of independent pieces. A
//! single machine computes all pieces, a part computes its own pieces, and a merge runs the same command, but takes the
//! pieces from its input. A part's line contains the version, the options and the robot, so that parts of different
//! computations cannot be mixed.

use std::collections::BTreeMap;
use std::io;
use std::str::FromStr;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::shared::json;
use crate::{Failure, RobotArgs};

/// The largest number of parts, more than any job queue needs.
const MAX_PARTS: u32 = 1_000_000;

/// One of several parts of a computation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Part {
    /// The number of this part, starting at 1.
    pub(crate) number: u32,
    /// The total number of parts.
    pub(crate) part_count: u32,
}

impl FromStr for Part {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let format_error = || {
            format!("expected K/N with K from 1 to N and N at most {MAX_PARTS}, for example 2/8")
        };
        let (number, part_count) = text.split_once('/').ok_or_else(format_error)?;
        let (Ok(number), Ok(part_count)) = (number.parse(), part_count.parse()) else {
            return Err(format_error());
        };
        match (1..=MAX_PARTS).contains(&part_count) && (1..=part_count).contains(&number) {
            true => Ok(Self { number, part_count }),
            false => Err(format_error()),
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
        format!("{}/{}", part.number, part.part_count)
    }
}

impl Part {
    /// True if the piece with this index belongs to this part. Neighbouring pieces belong to different parts because
    /// slow pieces are often neighbours.
    fn has_piece(self, piece: usize) -> bool {
        piece % self.part_count as usize == self.number as usize - 1
    }

    /// Returns the number of this part's pieces if all parts together have `total_count` pieces.
    pub fn count_pieces(self, total_count: usize) -> usize {
        let pieces = (0..total_count).filter(|piece| self.has_piece(*piece));
        pieces.count()
    }

    /// Computes this part's pieces and prints them.
    ///
    /// # Errors
    /// Fails if the robot cannot be read, or the output cannot be written.
    pub fn compute_and_print<C: Spreadable, T: Serialize>(
        self,
        command: &C,
        robot_args: &RobotArgs,
        piece_count: usize,
        mut compute_piece: impl FnMut(usize) -> T,
    ) -> Result<(), Failure> {
        let robot_toml = robot_args.text()?.to_owned();
        let mut results = BTreeMap::new();
        for index in (0..piece_count).filter(|index| self.has_piece(*index)) {
            results.insert(index, serde_json::to_value(compute_piece(index))?);
        }
        let output = PartOutput {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            command: C::COMMAND.to_owned(),
            options: serde_json::to_value(command)?,
            robot: robot_toml,
            part: self,
            piece_count,
            results,
        };
        Ok(json::write_line(&mut io::stdout().lock(), &output)?)
    }
}

/// The options `--robot` and `--part` of a computation that can be spread over machines.
#[derive(clap::Args, Debug, Default)]
pub struct SpreadArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,
    /// Compute only one of N parts, and print it for `lizard merge`
    #[arg(long, value_name = "K/N", help_heading = "Spread over machines")]
    part: Option<Part>,
    /// The results of all parts, in a merge.
    #[arg(skip)]
    merged: Option<BTreeMap<usize, Value>>,
}

/// A command that can be spread over machines. Its serialized form contains all options except the robot.
pub trait Spreadable: Serialize + DeserializeOwned {
    /// The command's name.
    const COMMAND: &'static str;

    /// Returns the options `--robot` and `--part` of this command.
    fn spread_args(&mut self) -> &mut SpreadArgs;
}

/// The output of one part; the serialized field names are the JSON keys.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PartOutput {
    /// The program's version.
    #[serde(rename = "lizard")]
    pub(crate) version: String,
    pub(crate) command: String,
    pub(crate) options: Value,
    /// The text of robot.toml.
    pub(crate) robot: String,
    pub(crate) part: Part,
    /// The total number of pieces in all parts.
    #[serde(rename = "pieces")]
    pub(crate) piece_count: usize,
    /// The results of this part's pieces, by piece index.
    #[serde(rename = "found")]
    pub(crate) results: BTreeMap<usize, Value>,
}

impl SpreadArgs {
    /// Sets the robot and the results of all parts, for a merge.
    pub(crate) fn set_merged(&mut self, robot: String, results: BTreeMap<usize, Value>) {
        self.robot = RobotArgs::from_text(robot);
        self.merged = Some(results);
    }

    /// Returns the part to compute; `None` if `--part` is not given.
    pub fn part(&self) -> Option<Part> {
        self.part
    }

    /// In a merge, returns the pieces of all parts in order; otherwise `None`.
    ///
    /// # Errors
    /// Fails if the parts belong to another computation.
    pub fn read_merged<T: DeserializeOwned>(
        &self,
        piece_count: usize,
    ) -> Result<Option<Vec<T>>, Failure> {
        let Some(merged) = &self.merged else {
            return Ok(None);
        };
        if !merged.keys().copied().eq(0..piece_count) {
            return Err(mismatched_parts_failure());
        }
        let pieces: Result<Vec<T>, _> = merged.values().map(T::deserialize).collect();
        pieces.map(Some).map_err(|_| mismatched_parts_failure())
    }

    /// Returns all pieces in order. `compute_piece` computes a piece from its index; in a merge, the pieces come from
    /// the parts. With `--part`, prints that part's pieces and returns `None`.
    ///
    /// # Errors
    /// Fails if the output cannot be written, or the parts belong to another computation.
    pub fn run_pieces<T: Serialize + DeserializeOwned>(
        &self,
        command: &impl Spreadable,
        piece_count: usize,
        compute_piece: impl FnMut(usize) -> T,
    ) -> Result<Option<Vec<T>>, Failure> {
        if let Some(part) = self.part {
            return part
                .compute_and_print(command, &self.robot, piece_count, compute_piece)
                .map(|()| None);
        }
        let compute_all = || (0..piece_count).map(compute_piece).collect();
        let pieces = self.read_merged(piece_count)?;
        Ok(Some(pieces.unwrap_or_else(compute_all)))
    }

    /// Returns the number of pieces that this run computes, for a progress bar.
    pub fn count_own_pieces(&self, total_count: usize) -> usize {
        match (&self.merged, self.part) {
            (Some(_), _) => 0,
            (None, None) => total_count,
            (None, Some(part)) => part.count_pieces(total_count),
        }
    }
}

/// Returns the failure for parts that belong to another computation.
pub(crate) fn mismatched_parts_failure() -> Failure {
    Failure::Input("the parts belong to another computation".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_piece_belongs_to_exactly_one_part() {
        for part_count in [1, 2, 3, 7, 40] {
            for piece in 0..20 {
                let parts = (1..=part_count).map(|number| Part { number, part_count });
                let owners = parts.filter(|part| part.has_piece(piece));
                assert_eq!(owners.count(), 1, "piece {piece} of {part_count} parts");
            }
        }
    }

    #[test]
    fn only_valid_parts_are_parsed() {
        let (number, part_count) = (2, 8);
        assert_eq!("2/8".parse(), Ok(Part { number, part_count }));
        for invalid_text in [
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
            let message = invalid_text.parse::<Part>().expect_err(invalid_text);
            let start = "expected K/N with K from 1 to N";
            assert!(message.starts_with(start), "{invalid_text}: {message}");
        }
    }
}
