//! The maps of cells in which the integer guard is proven to accept every pose.
//!
//! On the chip, computing a pose's distance from every hazard takes most of a frame's time. But each condition depends
//! only on one servo, on the two servos of the head or tail five-bar, or on the two servos of a side. The poses that
//! are far from every limit can therefore be listed in advance, in four maps over pairs of servos
//! ([`lizard_core::numbers::cells`]). This module computes the maps from the robot's true lengths, with bounds over
//! whole cells and error bounds of the guard's integers. It samples no poses, so the proof is valid for every pose of a
//! cell.

mod cell;
mod end;
mod side;

use std::ops::RangeInclusive;

use lizard_core::numbers::calibration::Calibration;
use lizard_core::numbers::cells::{COLUMN_BITS, MAX_ROWS, ROW_BITS};
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::section::{Content, Map};
use lizard_core::numbers::units::Angle;
use lizard_kinematics::{End, Lizard, Side};

use cell::{Cell, Condition, Span};

/// The maps of a robot. A pose is certified if all four maps contain it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CellMaps {
    /// Map of the head: rows A1, columns A2.
    pub head: Map,
    /// Map of the tail: rows A3, columns A4.
    pub tail: Map,
    /// Map of the left side: rows A1, columns A4.
    pub left: Map,
    /// Map of the right side: rows A2, columns A3.
    pub right: Map,
}

/// The first and the last column of a row without cells.
const EMPTY_ROW: [i8; 2] = [1, 0];

impl CellMaps {
    /// Computes the maps from the true lengths and from the firmware's integers.
    pub(crate) fn new(lizard: &Lizard, numbers: &Content) -> Self {
        let certify_end =
            |end: End| certify(&end::EndConditions::new(lizard, numbers, end), numbers);
        let certify_side =
            |side: Side| certify(&side::StrokeCondition::new(lizard, numbers, side), numbers);
        Self {
            head: certify_end(End::Head),
            tail: certify_end(End::Tail),
            left: certify_side(Side::Left),
            right: certify_side(Side::Right),
        }
    }

    /// True if all four maps contain a pose, so that the guard accepts it.
    pub fn contains(&self, pose: &Pose) -> bool {
        let [a1, a2, a3, a4] = pose.0;
        self.head.cells().contains(a1, a2)
            && self.tail.cells().contains(a3, a4)
            && self.left.cells().contains(a1, a4)
            && self.right.cells().contains(a2, a3)
    }
}

/// Computes the map of the cells in which a condition is proven.
fn certify(condition: &impl Condition, numbers: &Content) -> Map {
    let [row, column] = condition.servos().map(|servo| DividedServo {
        neutral: numbers.neutral_angles[servo],
        calibration: numbers.calibration[servo],
    });
    let half_rows = MAX_ROWS as i32 / 2;
    let rows = row.overlapping_cells(ROW_BITS, -half_rows..=half_rows - 1);
    let columns = column.overlapping_cells(COLUMN_BITS, i8::MIN.into()..=i8::MAX.into());
    let first_row = *rows.start();
    let all_rows: Vec<[i8; 2]> = rows
        .map(|cell| {
            let row_span = row.cell_span(cell, ROW_BITS);
            find_certified_columns(&columns, |cell| {
                let column_span = column.cell_span(cell, COLUMN_BITS);
                Cell([row_span, column_span]).has_proof_of(condition)
            })
        })
        .collect();
    let is_occupied = |row: &[i8; 2]| row[0] <= row[1];
    let first = all_rows.iter().position(is_occupied);
    let last = all_rows.iter().rposition(is_occupied);
    let (Some(first), Some(last)) = (first, last) else {
        return Map::default();
    };
    Map {
        first_row: (first_row + first as i32) as i8,
        rows: all_rows[first..=last].to_vec(),
    }
}

/// A servo whose travel is divided into cells.
struct DividedServo {
    /// Neutral angle, chassis frame.
    neutral: Angle,
    calibration: Calibration,
}

impl DividedServo {
    /// Returns the indices of the cells that overlap the servo's travel, within the range that a map can contain.
    fn overlapping_cells(&self, bits: u32, allowed: RangeInclusive<i32>) -> RangeInclusive<i32> {
        let [min, max] = [self.calibration.travel_min, self.calibration.travel_max]
            .map(|end| i32::from(end.0 >> bits));
        min.max(*allowed.start())..=max.min(*allowed.end())
    }

    /// Returns the range of a cell's angles in the chassis frame, from its first sweep to its last.
    fn cell_span(&self, cell: i32, bits: u32) -> Span {
        let first = f64::from(i32::from(self.neutral.0) + (cell << bits));
        Span {
            min: first,
            max: first + f64::from((1 << bits) - 1),
        }
    }
}

/// Finds the first and last of the contiguous certified columns around the certified column nearest to neutral.
/// Returns [`EMPTY_ROW`] if no column is certified.
fn find_certified_columns(
    columns: &RangeInclusive<i32>,
    is_certified: impl Fn(i32) -> bool,
) -> [i8; 2] {
    let mut candidates: Vec<i32> = columns.clone().collect();
    candidates.sort_by_key(|column| (2 * column + 1).abs());
    let Some(nearest) = candidates.into_iter().find(|column| is_certified(*column)) else {
        return EMPTY_ROW;
    };
    let columns_after = (nearest + 1..=*columns.end()).take_while(|column| is_certified(*column));
    let columns_before = (*columns.start()..nearest)
        .rev()
        .take_while(|column| is_certified(*column));
    [
        columns_before.last().unwrap_or(nearest) as i8,
        columns_after.last().unwrap_or(nearest) as i8,
    ]
}

#[cfg(test)]
mod tests;
