//! Reads the tags of the sheet in a frame.
//!
//! [`read_tags`] finds dark quadrilaterals, refines their edges and reads their codes. Of the 587 codes of the AprilTag
//! family 36h11, only those on the sheet are recognised. Any two of these differ in at least eleven cells in every
//! orientation, so a few misread cells do no harm.

use crate::blobs::{self, Quad};
use crate::edges::{self, TagOutline};
use crate::frame::{Frame, Pixel};
use crate::homography::Homography;
use crate::sheet::{CELLS_PER_SIDE, CODES, is_white};

/// Largest number of misread cells with which a tag is still recognised.
const MAX_MISREAD_CELLS: usize = 3;

/// Largest displacement of a tag between two frames that [`find_tag_near`] tolerates, as a fraction of the tag's size.
const MAX_DISPLACEMENT_FRACTION: f64 = 0.3;

/// A tag that was detected in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tag {
    /// The id on the sheet.
    pub id: usize,
    /// The corners that are printed top left, top right, bottom right and bottom left.
    pub corners: [Pixel; 4],
}

/// Finds the tags of the sheet in a frame. If an id appears twice, both tags are returned.
pub fn read_tags(frame: &Frame) -> Vec<Tag> {
    decode_quads(frame, blobs::find_quads(frame, blobs::half_window(frame)))
}

/// Finds the tag with an id near its last position; `None` if the tag is not there. The result equals that of
/// [`read_tags`] if the tag moved by less than [`MAX_DISPLACEMENT_FRACTION`] of its size.
pub(crate) fn find_tag_near(frame: &Frame, id: usize, last_corners: &[Pixel; 4]) -> Option<Tag> {
    let half_window = blobs::half_window(frame);
    let size = frame.size();
    let (mut min, mut max) = ([0; 2], size);
    for i in 0..2 {
        let [smallest, largest] = [f64::min, f64::max]
            .map(|extreme| last_corners.iter().map(|corner| corner[i]).reduce(extreme));
        let (smallest, largest) = (smallest?, largest?);
        // The cropped frame must include the windows with which the tag's pixels are compared.
        let margin = (largest - smallest) * MAX_DISPLACEMENT_FRACTION + half_window as f64 + 2.0;
        min[i] = (smallest - margin).max(0.0) as usize;
        max[i] = size[i].min((largest + margin).max(0.0) as usize);
    }
    let quads = blobs::find_quads(&frame.crop(min, max)?, half_window).into_iter();
    let quads_in_frame =
        quads.map(|quad| quad.map(|[x, y]| [x + min[0] as f64, y + min[1] as f64]));
    let mut tags = decode_quads(frame, quads_in_frame).into_iter();
    tags.find(|tag| tag.id == id)
}

/// Reads the codes of quadrilaterals in a frame, and returns the tags of the sheet.
fn decode_quads(frame: &Frame, quads: impl IntoIterator<Item = Quad>) -> Vec<Tag> {
    let quads = quads.into_iter();
    quads
        .filter_map(|quad| edges::refine_quad(frame, quad))
        .filter_map(|outline| decode(frame, &outline))
        .collect()
}

/// Reads the code within an outline in all four orientations; `None` if no tag of the sheet has any of these codes.
fn decode(frame: &Frame, outline: &TagOutline) -> Option<Tag> {
    (0..4).find_map(|quarter_turns| {
        let corners = std::array::from_fn(|i| outline.corners[(i + quarter_turns) % 4]);
        let side = CELLS_PER_SIDE as f64;
        let square = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
        let to_frame = Homography::from_points(&square, &corners)?;
        let appears_white = |row: usize, column: usize| {
            let offsets = [
                [0.0, 0.0],
                [0.2, 0.2],
                [0.2, -0.2],
                [-0.2, 0.2],
                [-0.2, -0.2],
            ];
            let grey = offsets.map(|[x, y]| {
                let point = [column as f64 + 0.5 + x, row as f64 + 0.5 + y];
                frame.grey_at(to_frame.map(point))
            });
            grey.iter().sum::<f64>() / offsets.len() as f64 > outline.mid_grey
        };
        let white_cells: [bool; CELLS_PER_SIDE * CELLS_PER_SIDE] =
            std::array::from_fn(|i| appears_white(i / CELLS_PER_SIDE, i % CELLS_PER_SIDE));
        let count_misread_cells = |id: usize| {
            let is_misread =
                |&i: &usize| white_cells[i] != is_white(id, i / CELLS_PER_SIDE, i % CELLS_PER_SIDE);
            (0..white_cells.len()).filter(is_misread).count()
        };
        let id = (0..CODES.len()).find(|&id| count_misread_cells(id) <= MAX_MISREAD_CELLS)?;
        Some(Tag { id, corners })
    })
}
