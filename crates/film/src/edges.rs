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
const END_SHARE: f64 = 0.12;
/// Distance to either side of an edge over which grey is sampled, px, if the tag is large enough.
const MAX_ACROSS: f64 = 4.0;
/// Largest such distance, as a share of a square's width, which limits it for small tags: the code begins one
/// square inside, and the first corners have an error of a pixel.
const MAX_ACROSS_SHARE: f64 = 0.6;
/// Distance between samples across an edge, px.
const STEP_PX: f64 = 0.5;
/// Smallest difference of brightness that counts as an edge, in grey levels.
const MIN_CONTRAST: f64 = 25.0;
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
        let corners = square.corners;
        let edges: [Option<(Line, f64)>; 4] =
            std::array::from_fn(|i| fit_edge(picture, corners[i], corners[(i + 1) % 4]));
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
fn fit_edge(picture: &Picture, from: Pixel, to: Pixel) -> Option<(Line, f64)> {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let length = dx.hypot(dy);
    let across = MAX_ACROSS.min(MAX_ACROSS_SHARE * length / SQUARES as f64);
    if !(2.0 * STEP_PX..1e4).contains(&across) {
        return None;
    }
    let (along, normal) = ([dx / length, dy / length], [dy / length, -dx / length]);
    let half_count = (across / STEP_PX) as usize;
    let count = ((length * (1.0 - 2.0 * END_SHARE)) as usize).max(4);
    let start = END_SHARE * length;
    let stride = length * (1.0 - 2.0 * END_SHARE) / (count - 1) as f64;
    let mut profiles = vec![0.0; count * (2 * half_count + 1)];
    for (i, profile) in profiles.chunks_mut(2 * half_count + 1).enumerate() {
        let s = start + i as f64 * stride;
        for (j, grey) in profile.iter_mut().enumerate() {
            let t = (j as f64 - half_count as f64) * STEP_PX;
            *grey = picture.at([
                from[0] + s * along[0] + t * normal[0],
                from[1] + s * along[1] + t * normal[1],
            ]);
        }
    }
    let column_mean = |j: usize| {
        let sum: f64 = profiles
            .chunks(2 * half_count + 1)
            .map(|profile| profile[j])
            .sum();
        sum / count as f64
    };
    let (black, white) = (
        (column_mean(0) + column_mean(1)) / 2.0,
        (column_mean(2 * half_count) + column_mean(2 * half_count - 1)) / 2.0,
    );
    if white - black < MIN_CONTRAST {
        return None;
    }
    // Fits the straight line t = offset + slope s by least squares; s starts at the middle of the edge.
    let (mut sum, mut moment, mut square_sum) = (0.0, 0.0, 0.0);
    let mut places = Vec::with_capacity(count);
    for (i, profile) in profiles.chunks(2 * half_count + 1).enumerate() {
        let ends_mean = (profile[0] + profile[2 * half_count]) / 2.0;
        let grey = profile.iter().sum::<f64>() - ends_mean;
        let bright_width = STEP_PX * (grey - black * (2 * half_count) as f64) / (white - black);
        let (s, t) = (
            (i as f64 - (count - 1) as f64 / 2.0) * stride,
            half_count as f64 * STEP_PX - bright_width,
        );
        places.push((s, t));
        sum += t;
        moment += s * t;
        square_sum += s * s;
    }
    let (offset, slope) = (sum / count as f64, moment / square_sum);
    let square_errors = places.iter().map(|(s, t)| (t - offset - slope * s).powi(2));
    if (square_errors.sum::<f64>() / count as f64).sqrt() > MAX_EDGE_DEVIATION {
        return None;
    }
    let middle = length / 2.0;
    let line = Line {
        at: std::array::from_fn(|i| from[i] + middle * along[i] + offset * normal[i]),
        along: std::array::from_fn(|i| along[i] + slope * normal[i]),
    };
    Some((line, (black + white) / 2.0))
}

/// The intersection of two lines; `None` if they are parallel.
fn intersect(a: &Line, b: &Line) -> Option<Pixel> {
    let cross = a.along[0] * b.along[1] - a.along[1] * b.along[0];
    let [x, y] = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
    let distance = (x * b.along[1] - y * b.along[0]) / cross;
    let point = [
        a.at[0] + distance * a.along[0],
        a.at[1] + distance * a.along[1],
    ];
    point.iter().all(|value| value.is_finite()).then_some(point)
}
