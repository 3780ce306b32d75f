//! The pairs of positions of two servos: a row is a position of the first servo, a column a position of the second.
//! Rows are distributed over all cores, and a row's columns are computed eight at a time.

use std::array::from_fn;

use lizard_core::numbers::units::ONE_Q15;
use lizard_kinematics::{Lanes, Vector};
use rayon::prelude::*;

use crate::positions::Positions;
use crate::tally::Tally;

/// Number of columns that are computed at once in floating point.
pub const LANE_COUNT: usize = 8;

/// Number of pieces into which the rows of each part are divided; a part is an end or a side.
pub const PIECES_PER_PART: usize = 64;

/// A sample of the pairs: in each row, the columns whose remainder modulo `one_in` is that of the row's index plus
/// `offset`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PairSample {
    /// One pair out of this number is compared; at least 1.
    pub one_in: u32,
    /// Offset of the selected columns in row 0, below `one_in`.
    pub offset: u32,
}

/// A group of columns of one row: [`LANE_COUNT`] columns, and the number of those at the start that belong to the
/// sample. The others fill the group.
pub type Group = ([usize; LANE_COUNT], usize);

/// A function that compares the pairs of a row (given by its index) and a group of columns, and adds them to a tally.
pub type CompareGroup<'a> = dyn Fn([&Positions; 2], &mut Tally, usize, Group) + Sync + 'a;

/// Compares the pairs of a piece that belong to a sample: calls `compare_group` for each row of the piece and each
/// group of the row's columns. Calls `report_progress` with the number of rows completed since the last call. Returns
/// the sum of the rows' tallies.
pub fn tally_rows(
    positions: [&Positions; 2],
    sample: PairSample,
    piece_in_part: usize,
    report_progress: &(dyn Fn(u64) + Sync),
    compare_group: &CompareGroup<'_>,
) -> Tally {
    let [row_count, column_count] = positions.map(|positions| positions.degrees.len());
    let (one_in, offset) = (sample.one_in as usize, sample.offset as usize);
    (row_count * piece_in_part / PIECES_PER_PART..row_count * (piece_in_part + 1) / PIECES_PER_PART)
        .into_par_iter()
        .map(|row| {
            let mut tally = Tally::default();
            let first_column = (row + offset) % one_in;
            for start in (first_column..column_count).step_by(LANE_COUNT * one_in) {
                let columns = from_fn(|lane| (start + lane * one_in).min(column_count - 1));
                let valid_count = (column_count - start).div_ceil(one_in).min(LANE_COUNT);
                compare_group(positions, &mut tally, row, (columns, valid_count));
            }
            report_progress(1);
            tally
        })
        .reduce(Tally::default, Tally::merge)
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
