//! Reading the tags of the sheet in a picture.
//!
//! [`read`] finds dark quadrilaterals, refines their edges and reads their codes. Of the family's 587 codes, only
//! those on the sheet are known here. They differ in eleven squares or more in every orientation, so a few misread
//! squares do no harm.

use crate::blobs::{self, Quad};
use crate::edges::{self, Square};
use crate::homography::Homography;
use crate::picture::{Picture, Pixel};
use crate::sheet::{CODES, SQUARES, is_white};

/// Largest number of misread squares of a tag.
const LARGEST_ERROR: usize = 3;

/// Largest movement of a tag from one picture to the next, as a share of its size, for which it is searched near its
/// last place.
const MAX_MOVE_SHARE: f64 = 0.3;

/// A tag in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tag {
    /// The id on the sheet.
    pub id: usize,
    /// The corners: top left, top right, bottom right, bottom left, as printed.
    pub corners: [Pixel; 4],
}

/// Finds the tags of the sheet in a picture. If an id appears twice, both tags are returned.
pub fn read(picture: &Picture) -> Vec<Tag> {
    read_tags(picture, blobs::quads(picture, blobs::reach(picture)))
}

/// Finds the tag of an id near its last place; `None` if it is not there. Finds it as [`read`] does if it moved by
/// less than [`MAX_MOVE_SHARE`] of its size.
pub(crate) fn near(picture: &Picture, id: usize, last_corners: &[Pixel; 4]) -> Option<Tag> {
    let reach = blobs::reach(picture);
    let size = picture.size();
    let (mut low, mut high) = ([0; 2], size);
    for i in 0..2 {
        let [smallest, largest] = [f64::min, f64::max]
            .map(|extreme| last_corners.iter().map(|corner| corner[i]).reduce(extreme));
        let (smallest, largest) = (smallest?, largest?);
        // The part has to include the surroundings of the tag's pixels, too.
        let margin = (largest - smallest) * MAX_MOVE_SHARE + reach as f64 + 2.0;
        low[i] = (smallest - margin).max(0.0) as usize;
        high[i] = size[i].min((largest + margin).max(0.0) as usize);
    }
    let quads = blobs::quads(&picture.part(low, high)?, reach).into_iter();
    let quads_in_picture =
        quads.map(|quad| quad.map(|[x, y]| [x + low[0] as f64, y + low[1] as f64]));
    let mut tags = read_tags(picture, quads_in_picture).into_iter();
    tags.find(|tag| tag.id == id)
}

/// Reads the tags among quadrilaterals of a picture.
fn read_tags(picture: &Picture, quads: impl IntoIterator<Item = Quad>) -> Vec<Tag> {
    let quads = quads.into_iter();
    quads
        .filter_map(|quad| edges::refine(picture, quad))
        .filter_map(|square| decode(picture, &square))
        .collect()
}

/// Reads the code of a square, starting at each of its corners in turn; `None` if no tag of the sheet has this
/// code.
fn decode(picture: &Picture, square: &Square) -> Option<Tag> {
    (0..4).find_map(|turn| {
        let corners = std::array::from_fn(|i| square.corners[(i + turn) % 4]);
        let edge = SQUARES as f64;
        let to_picture = Homography::of_four(
            [[0.0, 0.0], [edge, 0.0], [edge, edge], [0.0, edge]],
            corners,
        )?;
        let is_seen_white = |row: usize, column: usize| {
            let offsets = [
                [0.0, 0.0],
                [0.2, 0.2],
                [0.2, -0.2],
                [-0.2, 0.2],
                [-0.2, -0.2],
            ];
            let grey = offsets.map(|[x, y]| {
                let point = [column as f64 + 0.5 + x, row as f64 + 0.5 + y];
                picture.at(to_picture.map(point))
            });
            grey.iter().sum::<f64>() / offsets.len() as f64 > square.middle
        };
        let seen_white: [[bool; SQUARES]; SQUARES] =
            std::array::from_fn(|row| std::array::from_fn(|column| is_seen_white(row, column)));
        let count_errors = |id: usize| {
            let squares = (0..SQUARES * SQUARES).map(|i| (i / SQUARES, i % SQUARES));
            squares
                .filter(|&(row, column)| seen_white[row][column] != is_white(id, row, column))
                .count()
        };
        let id = (0..CODES.len()).find(|&id| count_errors(id) <= LARGEST_ERROR)?;
        Some(Tag { id, corners })
    })
}
