//! The rows and columns of positions: rows are distributed over all cores, columns are computed eight at a time.

use lizard_core::numbers::units::ONE_Q15;
use lizard_kinematics::{Lanes, Vector};
use rayon::prelude::*;

use crate::positions::Positions;
use crate::tally::Tally;

/// Columns that floating point computes at once.
pub const LANES: usize = 8;

/// Number of pieces into which the rows of an end or a side are divided.
pub const CUTS: usize = 64;

/// A sample of the pairs: in each row, the pairs whose column has a given remainder modulo `one_in`. The remainder
/// differs from row to row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PairSample {
    /// One pair in this number is checked; at least 1.
    pub one_in: u32,
    /// Offset of the selected pairs, below `one_in`.
    pub offset: u32,
}

impl PairSample {
    /// The sample that contains all pairs.
    pub const ALL: Self = Self {
        one_in: 1,
        offset: 0,
    };
}

/// The columns of a row that belong to a sample.
pub fn columns(sample: PairSample, row: usize, count: usize) -> impl Iterator<Item = usize> {
    let first = (row + sample.offset as usize) % sample.one_in as usize;
    (first..count).step_by(sample.one_in as usize)
}

/// Computes the rows of a piece on all cores, and adds their tallies.
pub fn tally_rows(
    row_positions: &Positions,
    cut: usize,
    progress: &(dyn Fn(u64) + Sync),
    tally_row: impl Fn(usize) -> Tally + Sync,
) -> Tally {
    let rows = row_positions.fixed.len();
    (rows * cut / CUTS..rows * (cut + 1) / CUTS)
        .into_par_iter()
        .map(|index| {
            let tally = tally_row(index);
            progress(1);
            tally
        })
        .reduce(Tally::default, Tally::merged)
}

/// Calls `take` with the columns of a row, eight at a time, and with the number of valid ones; the last column is
/// repeated to fill the eight.
pub fn for_each_eight(
    mut columns: impl Iterator<Item = usize>,
    mut take: impl FnMut([usize; LANES], usize),
) {
    loop {
        let mut eight = [0; LANES];
        let mut count = 0;
        for column in columns.by_ref().take(LANES) {
            eight[count..].fill(column);
            count += 1;
        }
        if count == 0 {
            return;
        }
        take(eight, count);
    }
}

#[inline]
/// Gathers the vectors of eight columns.
pub fn lanes(vectors: &[Vector], columns: [usize; LANES]) -> Vector<Lanes<LANES>> {
    Vector::new(
        Lanes(columns.map(|column| vectors[column].x)),
        Lanes(columns.map(|column| vectors[column].y)),
    )
}

#[inline]
/// Repeats a vector in all lanes.
pub fn splat(vector: Vector) -> Vector<Lanes<LANES>> {
    Vector::new(Lanes([vector.x; LANES]), Lanes([vector.y; LANES]))
}

/// Converts a margin of the firmware to a sine.
#[inline]
pub fn q15_to_sine(q15: i16) -> f64 {
    f64::from(q15) / f64::from(ONE_Q15)
}
