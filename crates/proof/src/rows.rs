//! The rows and columns of pairs of positions. Rows are distributed over all cores, and a row's columns are computed
//! eight at a time.

use lizard_core::numbers::units::ONE_Q15;
use lizard_kinematics::{Lanes, Vector};
use rayon::prelude::*;

use crate::positions::Positions;
use crate::tally::Tally;

/// Number of columns that are computed at once in floating point.
pub const LANE_COUNT: usize = 8;

/// Number of pieces into which the rows of each end and each side are divided.
pub const PIECES_PER_PART: usize = 64;

/// A sample of the pairs: in each row, the pairs whose column has a given remainder modulo `one_in`. The remainder
/// differs from row to row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PairSample {
    /// One pair out of this number is compared; at least 1.
    pub one_in: u32,
    /// Offset of the selected columns, below `one_in`.
    pub offset: u32,
}

impl PairSample {
    /// The sample that contains all pairs.
    pub const ALL: Self = Self {
        one_in: 1,
        offset: 0,
    };
}

/// Returns the columns of a row that belong to a sample.
pub fn select_columns(
    sample: PairSample,
    row: usize,
    column_count: usize,
) -> impl Iterator<Item = usize> {
    let first = (row + sample.offset as usize) % sample.one_in as usize;
    (first..column_count).step_by(sample.one_in as usize)
}

/// Computes the rows of a piece on all cores, and adds their tallies.
pub fn tally_rows(
    row_positions: &Positions,
    piece_index: usize,
    report_progress: &(dyn Fn(u64) + Sync),
    tally_row: impl Fn(usize) -> Tally + Sync,
) -> Tally {
    let row_count = row_positions.fixed.len();
    (row_count * piece_index / PIECES_PER_PART..row_count * (piece_index + 1) / PIECES_PER_PART)
        .into_par_iter()
        .map(|row| {
            let tally = tally_row(row);
            report_progress(1);
            tally
        })
        .reduce(Tally::default, Tally::merge)
}

/// Calls `visit` with the columns of a row, [`LANE_COUNT`] at a time, and with the number of valid columns. The last
/// column is repeated to fill the group.
pub fn for_each_group(
    mut columns: impl Iterator<Item = usize>,
    mut visit: impl FnMut([usize; LANE_COUNT], usize),
) {
    loop {
        let mut group = [0; LANE_COUNT];
        let mut valid_count = 0;
        for column in columns.by_ref().take(LANE_COUNT) {
            group[valid_count..].fill(column);
            valid_count += 1;
        }
        if valid_count == 0 {
            return;
        }
        visit(group, valid_count);
    }
}

/// Gathers the vectors of a group of columns, one for each lane.
#[inline]
pub fn gather_lanes(vectors: &[Vector], columns: [usize; LANE_COUNT]) -> Vector<Lanes<LANE_COUNT>> {
    Vector::new(
        Lanes(columns.map(|column| vectors[column].x)),
        Lanes(columns.map(|column| vectors[column].y)),
    )
}

/// Converts a margin of the firmware, Q15, to a sine.
#[inline]
pub fn q15_to_sine(q15: i16) -> f64 {
    f64::from(q15) / f64::from(ONE_Q15)
}
