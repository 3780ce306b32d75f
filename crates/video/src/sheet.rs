//! The layout of the printed sheet of tags. All dimensions on which a measurement depends are defined here.
//!
//! The robot is larger than a sheet of paper, so the sheet is cut into three pieces. Two strips lie on the floor, one
//! on either side of the robot's path, and a card lies on the robot's deck. The known distance between a strip's two
//! tags gives the scale. The strips' positions are found in the video, so nobody has to measure them. A ruler line on
//! each strip shows the scale at which the sheet was printed.
//!
//! The tags have the ids 0 to 4 of the AprilTag family 36h11, so other programs can read them, too.

/// A point of the sheet or of a tag, mm: to the right, and up.
pub type Point = [f64; 2];

/// The number of cells along an edge of a tag: six cells of the code between two black ones.
pub const CELLS_PER_SIDE: usize = 8;

/// The code of each tag, indexed by the tag's id: 36 bits, row by row from the top left cell, 1 for white.
pub const CODES: [u64; 5] = [
    0xd_5d62_8584,
    0xd_97f1_8b49,
    0xd_d280_910e,
    0xe_479e_9c98,
    0xe_bcbc_a822,
];

/// The number of strips.
pub const STRIP_COUNT: usize = 2;
/// The number of tags on a strip.
pub const TAGS_PER_STRIP: usize = 2;
/// The number of tags on the floor. Their ids start at 0.
pub const FLOOR_TAG_COUNT: usize = STRIP_COUNT * TAGS_PER_STRIP;
/// The id of the tag on the deck.
pub const DECK_TAG_ID: usize = FLOOR_TAG_COUNT;
/// Edge length of a tag on the floor, mm.
pub const FLOOR_TAG_EDGE: f64 = 50.0;
/// Edge length of the deck's tag, mm. The tag must fit on an Arduino UNO, which is 53 mm wide.
pub const DECK_TAG_EDGE: f64 = 36.0;
/// Distance between the centres of a strip's tags, mm.
pub const TAG_SPACING: f64 = 200.0;
/// Length and width of a strip, mm. The white margin around its tags is wider than one of their cells.
pub const STRIP_SIZE: [f64; 2] = [266.0, 66.0];
/// Width and length of the deck's card, mm. The tag is at the card's lower edge; the card's upper edge faces
/// the robot's head.
pub const CARD_SIZE: [f64; 2] = [50.0, 60.0];
/// White margin around the deck's tag, mm.
pub const CARD_MARGIN: f64 = 7.0;
/// Length of the line that shows the printer's scale, mm.
pub const RULER_LENGTH: f64 = 100.0;
/// Word beside the card's arrow, which points to the robot's head.
pub const FORWARD_WORD: &str = "HEAD";

/// Returns the index of a floor tag's strip.
pub fn strip_index(id: usize) -> usize {
    id / TAGS_PER_STRIP
}

/// Returns the centre of a floor tag, mm, relative to the centre of its strip; x runs along the strip.
pub fn centre_on_strip(id: usize) -> Point {
    let side = (id % TAGS_PER_STRIP) as f64 * 2.0 - 1.0;
    [side * TAG_SPACING / 2.0, 0.0]
}

/// Returns the edge length of a tag, mm.
pub fn tag_edge(id: usize) -> f64 {
    if id == DECK_TAG_ID {
        DECK_TAG_EDGE
    } else {
        FLOOR_TAG_EDGE
    }
}

/// Returns the corners of a tag relative to its centre, mm: top left, top right, bottom right, bottom left.
pub fn tag_corners(edge: f64) -> [Point; 4] {
    let half = edge / 2.0;
    [[-half, half], [half, half], [half, -half], [-half, -half]]
}

/// True if a cell of a tag is white. Row 0 is at the top, column 0 on the left.
pub fn is_white(id: usize, row: usize, column: usize) -> bool {
    let code_range = 1..CELLS_PER_SIDE - 1;
    let is_inside = code_range.contains(&row) && code_range.contains(&column);
    let code_side = CELLS_PER_SIDE - 2;
    is_inside
        && CODES[id] >> (code_side * code_side - 1 - ((row - 1) * code_side + column - 1)) & 1 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the codes of a tag in its four orientations.
    fn rotated_codes(id: usize) -> [u64; 4] {
        let bit = |row: usize, column: usize| u64::from(is_white(id, row + 1, column + 1));
        let pack_bits = |bit_at: &dyn Fn(usize, usize) -> u64| {
            (0..36).fold(0, |code, i| code << 1 | bit_at(i / 6, i % 6))
        };
        [
            pack_bits(&|row, column| bit(row, column)),
            pack_bits(&|row, column| bit(5 - column, row)),
            pack_bits(&|row, column| bit(5 - row, 5 - column)),
            pack_bits(&|row, column| bit(column, 5 - row)),
        ]
    }

    #[test]
    fn any_two_tags_in_any_orientation_differ_in_at_least_eleven_cells() {
        for (a, first_code) in CODES.into_iter().enumerate() {
            assert_eq!(rotated_codes(a)[0], first_code);
            for b in 0..CODES.len() {
                for (quarter_turns, second_code) in rotated_codes(b).into_iter().enumerate() {
                    let difference = (first_code ^ second_code).count_ones();
                    assert!(
                        (a == b && quarter_turns == 0) || difference >= 11,
                        "tags {a} and {b}, {quarter_turns} quarter turns: {difference}"
                    );
                }
            }
        }
    }

    #[test]
    fn every_tag_has_a_white_margin_wider_than_one_of_its_cells() {
        for id in 0..FLOOR_TAG_COUNT {
            let [x, y] = centre_on_strip(id).map(f64::abs);
            let cell = FLOOR_TAG_EDGE / CELLS_PER_SIDE as f64;
            let reach = FLOOR_TAG_EDGE / 2.0 + cell;
            assert!(x + reach < STRIP_SIZE[0] / 2.0 && y + reach < STRIP_SIZE[1] / 2.0);
        }
        const {
            assert!(CARD_MARGIN > DECK_TAG_EDGE / CELLS_PER_SIDE as f64);
            assert!(DECK_TAG_EDGE + 2.0 * CARD_MARGIN <= CARD_SIZE[0]);
        }
    }
}
