//! Certified cells: ranges of the sweeps of two servos in which the guard accepts every pose, so that the guard need
//! not measure these poses.
//!
//! Computing all margins of a pose takes most of the time in which a frame is computed, and far from all limits the
//! result is always "safe". Every condition of the guard depends on one or two servos, so four small maps over pairs of
//! servos can mark these safe ranges. The host makes the maps from a robot's numbers, and proves that the integer
//! arithmetic of [`crate::guard::clearance`] accepts every pose in every cell. A pose outside the cells is not
//! necessarily unsafe; the guard measures it.

use lizard_avr::Flash;

use crate::numbers::units::Sweep;

/// The largest number of rows that the host puts into a map.
pub const MAX_ROWS: usize = 64;

/// The binary logarithm of a row's width in steps of a sweep (1/65536 turn); the width is 1.4 deg.
pub const ROW_BITS: u32 = 8;

/// The binary logarithm of a column's width in steps of a sweep (1/65536 turn); the width is 0.7 deg.
pub const COLUMN_BITS: u32 = 7;

/// The map of the certified cells of a pair of servos, with rows in a table that several maps share. In a cell, every
/// condition of the guard that depends only on these two servos holds.
#[derive(Clone, Copy)]
pub struct CellMap<'a> {
    /// The row number of the map's first row, see [`CellMap::from_rows`].
    first_row: i8,
    /// The index of the map's first row in `rows`.
    start: u16,
    /// The number of rows in the map.
    row_count: u8,
    /// The rows of all maps.
    rows: Flash<'a, [[i8; 2]]>,
}

impl<'a> CellMap<'a> {
    /// Creates the map whose `row_count` rows begin at index `start` of `rows`. The rows have consecutive row numbers
    /// from `first_row` on, which wrap around after a turn. Each row is stored as its first and its last column number,
    /// both inclusive; the row is empty if the first number is greater than the last. A row number is a sweep divided
    /// by 2^[`ROW_BITS`], a column number is a sweep divided by 2^[`COLUMN_BITS`], both rounded down.
    #[inline(always)]
    pub const fn from_rows(
        first_row: i8,
        start: u16,
        row_count: u8,
        rows: Flash<'a, [[i8; 2]]>,
    ) -> Self {
        Self {
            first_row,
            start,
            row_count,
            rows,
        }
    }

    /// Creates the map that consists of all `rows`, at most 255.
    pub const fn new(first_row: i8, rows: Flash<'a, [[i8; 2]]>) -> Self {
        Self::from_rows(first_row, 0, rows.len() as u8, rows)
    }

    /// True if a cell contains this pair of sweeps: `row` selects the row, `column` the column. A column sweep
    /// outside -16 384..=16 383, a quarter of a turn, is in no cell, because its number does not fit into an `i8`.
    #[inline(always)]
    pub fn contains(&self, row: Sweep, column: Sweep) -> bool {
        let row = ((row.0 >> ROW_BITS) as i8).wrapping_sub(self.first_row) as u8;
        if row >= self.row_count {
            return false;
        }
        let Some(columns) = self.rows.get(usize::from(self.start) + usize::from(row)) else {
            return false;
        };
        let [first_column, last_column] = columns.load();
        let column = column.0 >> COLUMN_BITS;
        column >= i16::from(first_column) && column <= i16::from(last_column)
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    /// The reference implementation of [`CellMap::contains`], with divisions and without a shortcut.
    fn contains_by_division(first_row: i8, rows: &[[i8; 2]], row: i16, column: i16) -> bool {
        let row = f64::from(row).div_euclid(256.0) as i32;
        // A turn has 256 rows; the first row follows the last.
        let is_in_next_turn = row < i32::from(first_row);
        let row = if is_in_next_turn { row + 256 } else { row };
        let column = f64::from(column).div_euclid(128.0) as i32;
        rows.iter()
            .enumerate()
            .any(|(index, [first_column, last_column])| {
                i32::from(first_row) + index as i32 == row
                    && (i32::from(*first_column)..=i32::from(*last_column)).contains(&column)
            })
    }

    /// Sweeps at and next to every border of the columns in these tests, and a quarter of a turn from neutral, where
    /// the column numbers end.
    const COLUMNS: [i16; 17] = [
        -32_768, -16_385, -16_384, -16_257, -16_256, -1281, -1280, -129, -1, 0, 127, 128, 1407,
        1408, 16_383, 16_384, 32_767,
    ];

    /// Checks that [`CellMap::contains`] matches its reference at every sweep of the row servo and at all [`COLUMNS`].
    fn assert_matches_reference(first_row: i8, rows: &[[i8; 2]]) {
        let cells = CellMap::new(first_row, Flash::from(rows));
        for row in i16::MIN..=i16::MAX {
            for column in COLUMNS {
                assert_eq!(
                    cells.contains(Sweep(row), Sweep(column)),
                    contains_by_division(first_row, rows, row, column),
                    "row {row}, column {column} in {rows:?} from {first_row}"
                );
            }
        }
    }

    #[test]
    fn a_map_contains_exactly_the_pairs_within_the_columns_of_their_row() {
        let rows = [
            [-10, 10],
            [1, 0],
            [-128, 127],
            [0, 0],
            [-127, -2],
            [127, -128],
        ];
        // The maps are around neutral, at either end of the turn, and across the end of the turn.
        for first_row in [-3, 0, -128, 122, 125] {
            assert_matches_reference(first_row, &rows);
        }
        let max_rows: Vec<[i8; 2]> = (0..MAX_ROWS as i8).map(|n| [n - 40, n]).collect();
        assert_matches_reference(-32, &max_rows);
    }

    #[test]
    fn a_map_without_rows_contains_nothing() {
        assert_matches_reference(-5, &[]);
    }

    proptest! {
        #[test]
        fn maps_that_share_a_table_read_only_their_own_rows(
            first_rows: [i8; 2],
            maps in prop::array::uniform2(prop::collection::vec(any::<[i8; 2]>(), 0..100)),
            pairs in prop::collection::vec(any::<[i16; 2]>(), 300),
        ) {
            let rows = maps.concat();
            let rows = Flash::from(rows.as_slice());
            let starts = [0, maps[0].len() as u16];
            for map in 0..2 {
                let cells = CellMap::from_rows(first_rows[map], starts[map], maps[map].len() as u8, rows);
                for [row, column] in &pairs {
                    let expected = contains_by_division(first_rows[map], &maps[map], *row, *column);
                    prop_assert_eq!(cells.contains(Sweep(*row), Sweep(*column)), expected);
                }
            }
        }

        #[test]
        fn a_random_map_contains_exactly_the_pairs_in_its_rows(
            first_row: i8,
            rows in prop::collection::vec(any::<[i8; 2]>(), 0..256),
            pairs in prop::collection::vec(any::<[i16; 2]>(), 1000),
        ) {
            let cells = CellMap::new(first_row, Flash::from(rows.as_slice()));
            for [row, column] in pairs {
                let expected = contains_by_division(first_row, &rows, row, column);
                prop_assert_eq!(cells.contains(Sweep(row), Sweep(column)), expected);
            }
        }
    }
}
