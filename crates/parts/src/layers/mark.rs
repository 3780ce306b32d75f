//! Engraved marks for parts that are mirror images of each other.
//!
//! A link for A1 and its mirror image for A2 are hard to tell apart. If a part has variants, each variant is therefore
//! engraved with the numbers of its servos: 13 means A1 and A3. Digits consist of straight strokes.

use lizard_kinematics::Vector;

use crate::layers::body::Prism;
use crate::layers::outline::{Loop, Outline, compute_bounds};
use crate::layers::shape::Shape;

/// Width and height of a digit between the middles of its strokes, mm.
const DIGIT_SIZE: [f64; 2] = [1.9, 3.4];
/// Distance from one digit to the next, mm.
const DIGIT_PITCH: f64 = 3.5;
/// Half the width of a stroke, mm.
const STROKE_HALF_WIDTH: f64 = 0.35;
/// Depth of a stroke, mm: two printed layers.
pub const MARK_DEPTH: f64 = 0.4;
/// Smallest distance from a mark's strokes to the edge of its face, mm.
const MIN_BORDER: f64 = 0.7;
/// Distance in x between the positions tried for a mark, mm; twice the distance in y.
const POSITION_STEP: f64 = 0.8;

/// The strokes of a digit in a unit square, each as its two end points.
fn digit_strokes(digit: char) -> &'static [[(f64, f64); 2]] {
    const TOP: [(f64, f64); 2] = [(0.0, 1.0), (1.0, 1.0)];
    const MIDDLE: [(f64, f64); 2] = [(0.0, 0.5), (1.0, 0.5)];
    const BOTTOM: [(f64, f64); 2] = [(0.0, 0.0), (1.0, 0.0)];
    const LEFT_UP: [(f64, f64); 2] = [(0.0, 0.5), (0.0, 1.0)];
    const LEFT_DOWN: [(f64, f64); 2] = [(0.0, 0.0), (0.0, 0.5)];
    const RIGHT_UP: [(f64, f64); 2] = [(1.0, 0.5), (1.0, 1.0)];
    const RIGHT: [(f64, f64); 2] = [(1.0, 0.0), (1.0, 1.0)];
    match digit {
        '1' => &[[(0.5, 0.0), (0.5, 1.0)]],
        '2' => &[TOP, RIGHT_UP, MIDDLE, LEFT_DOWN, BOTTOM],
        '3' => &[TOP, MIDDLE, BOTTOM, RIGHT],
        '4' => &[LEFT_UP, MIDDLE, RIGHT],
        _ => &[],
    }
}

/// Draws the strokes of a mark whose lower left corner is at `position`.
pub fn draw_strokes(text: &str, position: Vector) -> Vec<Shape> {
    let [width, height] = DIGIT_SIZE;
    let mut strokes = Vec::new();
    for (index, digit) in text.chars().enumerate() {
        let corner = position + Vector::new(DIGIT_PITCH * index as f64, 0.0);
        let to_point = |(x, y): (f64, f64)| corner + Vector::new(x * width, y * height);
        let to_bar = |[from, to]: &[(f64, f64); 2]| {
            Shape::bar(to_point(*from), to_point(*to), STROKE_HALF_WIDTH)
        };
        strokes.extend(digit_strokes(digit).iter().map(to_bar));
    }
    strokes
}

/// Width and height of a mark, mm.
pub fn mark_size(text: &str) -> [f64; 2] {
    let count = text.chars().count() as f64;
    [DIGIT_PITCH * (count - 1.0) + DIGIT_SIZE[0], DIGIT_SIZE[1]]
}

/// Returns the layers with a mark engraved on an upper face; `None` if no face has room for the mark.
pub fn engrave_mark(prisms: &[Prism], text: &str) -> Option<Vec<Prism>> {
    let outlines: Vec<_> = prisms.iter().map(Outline::from_prism).collect();
    for (layer, prism) in prisms.iter().enumerate().rev() {
        let [low, high] = prism.z;
        if high - low < 2.0 * MARK_DEPTH {
            continue;
        }
        let upper_outline = outlines.get(layer + 1);
        let is_covered = |point| upper_outline.is_some_and(|outline| outline.contains(point));
        let is_free = |point: Vector| outlines[layer].contains(point) && !is_covered(point);
        let Some(position) = find_free_corner(&outlines[layer], text, is_free) else {
            continue;
        };
        let mut layers = prisms.to_vec();
        let lower = prism.at_heights([low, high - MARK_DEPTH]);
        let mut upper = prism.at_heights([high - MARK_DEPTH, high]);
        upper.cut_shapes.extend(draw_strokes(text, position));
        layers.splice(layer..=layer, [lower, upper]);
        return Some(layers);
    }
    None
}

/// Finds the lower left corner of a free place for a mark in an outline; `None` if there is no room.
fn find_free_corner(
    outline: &Outline,
    text: &str,
    is_free: impl Fn(Vector) -> bool,
) -> Option<Vector> {
    let ends = outline.loops().flat_map(Loop::sides_with_end_points);
    let [low, high] = compute_bounds(ends.flat_map(|(side, to)| [side.from, side.midpoint(to)]));
    let [width, height] = mark_size(text);
    let margin = STROKE_HALF_WIDTH + MIN_BORDER;
    let positions_between = |from: f64, to: f64, step: f64| {
        let count = ((to - from) / step).ceil().max(0.0) as u32;
        (0..=count).map(move |i| (from + f64::from(i) * step).min(to))
    };
    let [min_y, max_y] = [low.y + margin, high.y - margin - height];
    for x in positions_between(low.x + margin, high.x - margin - width, POSITION_STEP) {
        for y in positions_between(min_y, max_y, 0.5 * POSITION_STEP) {
            let mut columns = positions_between(x - margin, x + width + margin, 0.6);
            let rows = || positions_between(y - margin, y + height + margin, 0.6);
            if columns.all(|px| rows().all(|py| is_free(Vector::new(px, py)))) {
                return Some(Vector::new(x, y));
            }
        }
    }
    None
}
