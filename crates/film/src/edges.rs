//! Finds the edges of a tag with an error much smaller than a pixel.
//!
//! Lens and movement blur an edge over several pixels, but equally to both sides. So along a line across the edge,
//! the sum of grey is the same as for a sharp step, and the position of that step is the position of the edge. A
//! straight line is fitted to many of these positions. Its error is much smaller than a pixel, and two lines
//! intersect in a corner.

use crate::blobs::Quad;
use crate::picture::{Picture, Pixel};
use crate::sheet::SQUARES;

/// Share of an edge's length that is ignored next to each corner, since the adjacent edge is too near.
const ENDS: f64 = 0.12;
/// Distance to either side of an edge over which grey is sampled, px, if the tag is large enough.
const ACROSS: f64 = 4.0;
/// Largest such distance, as a share of a square's width, which limits it for small tags: the code begins one
/// square inside, and the first corners have an error of a pixel.
const ACROSS_SQUARE: f64 = 0.6;
/// Distance between samples across an edge, px.
const STEP: f64 = 0.5;
/// Smallest difference of brightness that counts as an edge, in grey levels.
const LEAST_CONTRAST: f64 = 25.0;
/// Largest root mean square distance of an edge's places from the fitted line, px.
const MAX_EDGE_DEVIATION: f64 = 0.7;
/// Number of iterations, each of which fits the lines again from better corners.
const ROUNDS: usize = 3;

/// The corners of a black square to sub-pixel accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Square {
    /// The corners, clockwise as seen in the picture.
    pub corners: Quad,
    /// The grey level halfway between black and white.
    pub middle: f64,
}

/// A line: a point on it, and its direction.
struct Line {
    at: Pixel,
    along: [f64; 2],
}

/// Refines the corners of a quadrilateral; `None` if it has no four straight edges, long enough, from black inside
/// to white outside.
pub(crate) fn refine(picture: &Picture, quad: Quad) -> Option<Square> {
    let mut square = Square {
        corners: quad,
        middle: 0.0,
    };
    for _ in 0..ROUNDS {
        let corner = square.corners;
        let edges: [Option<(Line, f64)>; 4] =
            std::array::from_fn(|i| edge(picture, corner[i], corner[(i + 1) % 4]));
        let mut lines = Vec::with_capacity(4);
        square.middle = 0.0;
        for edge in edges {
            let (line, middle) = edge?;
            lines.push(line);
            square.middle += middle / 4.0;
        }
        for i in 0..4 {
            square.corners[i] = intersect(&lines[(i + 3) % 4], &lines[i])?;
        }
    }
    Some(square)
}

/// Fits a line to the edge between two corners; returns the line, and the grey halfway between black and white.
/// `None` if the edge is too short, too long, without contrast, or not straight.
fn edge(picture: &Picture, from: Pixel, to: Pixel) -> Option<(Line, f64)> {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let length = dx.hypot(dy);
    let across = ACROSS.min(ACROSS_SQUARE * length / SQUARES as f64);
    if !(2.0 * STEP..1e4).contains(&across) {
        return None;
    }
    let (along, out) = ([dx / length, dy / length], [dy / length, -dx / length]);
    let half = (across / STEP) as usize;
    let count = ((length * (1.0 - 2.0 * ENDS)) as usize).max(4);
    let start = ENDS * length;
    let stride = length * (1.0 - 2.0 * ENDS) / (count - 1) as f64;
    let mut profiles = vec![0.0; count * (2 * half + 1)];
    for (i, profile) in profiles.chunks_mut(2 * half + 1).enumerate() {
        let s = start + i as f64 * stride;
        for (j, grey) in profile.iter_mut().enumerate() {
            let t = (j as f64 - half as f64) * STEP;
            *grey = picture.at([
                from[0] + s * along[0] + t * out[0],
                from[1] + s * along[1] + t * out[1],
            ]);
        }
    }
    let column = |j: usize| {
        let sum: f64 = profiles
            .chunks(2 * half + 1)
            .map(|profile| profile[j])
            .sum();
        sum / count as f64
    };
    let (black, white) = (
        (column(0) + column(1)) / 2.0,
        (column(2 * half) + column(2 * half - 1)) / 2.0,
    );
    if white - black < LEAST_CONTRAST {
        return None;
    }
    // Fits the straight line t = offset + slope s by least squares; s starts at the middle of the edge.
    let (mut sum, mut moment, mut square) = (0.0, 0.0, 0.0);
    let mut places = Vec::with_capacity(count);
    for (i, profile) in profiles.chunks(2 * half + 1).enumerate() {
        let ends = (profile[0] + profile[2 * half]) / 2.0;
        let grey = profile.iter().sum::<f64>() - ends;
        let bright = STEP * (grey - black * (2 * half) as f64) / (white - black);
        let (s, t) = (
            (i as f64 - (count - 1) as f64 / 2.0) * stride,
            half as f64 * STEP - bright,
        );
        places.push((s, t));
        sum += t;
        moment += s * t;
        square += s * s;
    }
    let (offset, slope) = (sum / count as f64, moment / square);
    let off = places.iter().map(|(s, t)| (t - offset - slope * s).powi(2));
    if (off.sum::<f64>() / count as f64).sqrt() > MAX_EDGE_DEVIATION {
        return None;
    }
    let middle = length / 2.0;
    let line = Line {
        at: std::array::from_fn(|i| from[i] + middle * along[i] + offset * out[i]),
        along: std::array::from_fn(|i| along[i] + slope * out[i]),
    };
    Some((line, (black + white) / 2.0))
}

/// The intersection of two lines; `None` if they are parallel.
fn intersect(a: &Line, b: &Line) -> Option<Pixel> {
    let cross = a.along[0] * b.along[1] - a.along[1] * b.along[0];
    let [x, y] = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
    let far = (x * b.along[1] - y * b.along[0]) / cross;
    let point = [a.at[0] + far * a.along[0], a.at[1] + far * a.along[1]];
    point.iter().all(|part| part.is_finite()).then_some(point)
}
