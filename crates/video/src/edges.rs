//! Finds the edges of a tag with sub-pixel accuracy.
//!
//! Lens and movement blur an edge over several pixels, but equally to both sides. The grey levels along a line across
//! the edge therefore have the same sum as for a sharp step at the edge's position. A straight line is fitted to many
//! of these positions, and two lines intersect in a corner.

use crate::blobs::Quad;
use crate::frame::{Frame, Pixel};
use crate::sheet::CELLS_PER_SIDE;

/// Fraction of an edge's length that is ignored next to each corner, because the adjacent edge is too near.
const END_FRACTION: f64 = 0.12;
/// Distance up to which grey is sampled on either side of an edge, px, if the tag is large enough.
const MAX_SAMPLING_DISTANCE: f64 = 4.0;
/// Largest sampling distance in a small tag, as a fraction of a cell's width. The code begins one cell inside the edge,
/// and the first corners have an error of a pixel.
const MAX_SAMPLING_FRACTION: f64 = 0.6;
/// Distance between samples across an edge, px.
const SAMPLE_SPACING: f64 = 0.5;
/// Smallest difference in brightness that counts as an edge, grey levels.
const MIN_CONTRAST: f64 = 25.0;
/// Largest root-mean-square distance of an edge's points from the fitted line, px.
const MAX_RMS_DEVIATION: f64 = 0.7;
/// Largest length of an edge, px: longer than any edge in a video, but finite.
const MAX_EDGE_LENGTH: f64 = 1e4;
/// Number of iterations; each fits the lines again, starting from the improved corners.
const ITERATION_COUNT: usize = 3;

/// The outline of a tag: a black square, found to sub-pixel accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TagOutline {
    /// The corners, clockwise as seen in the frame.
    pub corners: Quad,
    /// The grey level halfway between black and white.
    pub mid_grey: f64,
}

/// A straight line in the frame, given by a point on it and its direction.
struct Line {
    point: Pixel,
    direction: [f64; 2],
}

/// Refines the corners of a quadrilateral; `None` unless its four edges are straight, long enough, black inside and
/// white outside.
pub(crate) fn refine_quad(frame: &Frame, quad: Quad) -> Option<TagOutline> {
    let mut outline = TagOutline {
        corners: quad,
        mid_grey: 0.0,
    };
    for _ in 0..ITERATION_COUNT {
        let corners = outline.corners;
        let fit_edge_from = |i: usize| fit_edge(frame, corners[i], corners[(i + 1) % 4]);
        let edges: Vec<(Line, f64)> = (0..4).map(fit_edge_from).collect::<Option<_>>()?;
        outline.mid_grey = edges.iter().map(|(_, mid_grey)| mid_grey / 4.0).sum();
        for i in 0..4 {
            outline.corners[i] = intersect(&edges[(i + 3) % 4].0, &edges[i].0)?;
        }
    }
    Some(outline)
}

/// Fits a line to the edge between two corners, and returns it with the grey halfway between black and white. `None` if
/// the edge is too short, too long, without contrast, or not straight.
fn fit_edge(frame: &Frame, from: Pixel, to: Pixel) -> Option<(Line, f64)> {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let length = dx.hypot(dy);
    let sampling_distance =
        MAX_SAMPLING_DISTANCE.min(MAX_SAMPLING_FRACTION * length / CELLS_PER_SIDE as f64);
    if !(sampling_distance >= 2.0 * SAMPLE_SPACING && length < MAX_EDGE_LENGTH) {
        return None;
    }
    let (along, normal) = ([dx / length, dy / length], [dy / length, -dx / length]);
    let half_count = (sampling_distance / SAMPLE_SPACING) as usize;
    let profile_count = ((length * (1.0 - 2.0 * END_FRACTION)) as usize).max(4);
    let start = END_FRACTION * length;
    let stride = length * (1.0 - 2.0 * END_FRACTION) / (profile_count - 1) as f64;
    let mut profiles = vec![0.0; profile_count * (2 * half_count + 1)];
    for (i, profile) in profiles.chunks_mut(2 * half_count + 1).enumerate() {
        let distance_along = start + i as f64 * stride;
        for (j, grey) in profile.iter_mut().enumerate() {
            let t = (j as f64 - half_count as f64) * SAMPLE_SPACING;
            *grey = frame.grey_at(
                [0, 1].map(|axis| from[axis] + distance_along * along[axis] + t * normal[axis]),
            );
        }
    }
    let mean_grey_at = |j: usize| {
        let profiles = profiles.chunks(2 * half_count + 1);
        profiles.map(|profile| profile[j]).sum::<f64>() / profile_count as f64
    };
    let (black, white) = (
        (mean_grey_at(0) + mean_grey_at(1)) / 2.0,
        (mean_grey_at(2 * half_count) + mean_grey_at(2 * half_count - 1)) / 2.0,
    );
    if white - black < MIN_CONTRAST {
        return None;
    }
    // Fits the straight line t = offset + slope s by least squares: s runs along the edge from its centre, and t
    // runs outward across the edge.
    let (mut t_sum, mut st_sum, mut ss_sum) = (0.0, 0.0, 0.0);
    let mut edge_points = Vec::with_capacity(profile_count);
    for (i, profile) in profiles.chunks(2 * half_count + 1).enumerate() {
        let ends_mean = (profile[0] + profile[2 * half_count]) / 2.0;
        let grey_sum = profile.iter().sum::<f64>() - ends_mean;
        let bright_width =
            SAMPLE_SPACING * (grey_sum - black * (2 * half_count) as f64) / (white - black);
        let s = (i as f64 - (profile_count - 1) as f64 / 2.0) * stride;
        let t = half_count as f64 * SAMPLE_SPACING - bright_width;
        edge_points.push((s, t));
        t_sum += t;
        st_sum += s * t;
        ss_sum += s * s;
    }
    let (offset, slope) = (t_sum / profile_count as f64, st_sum / ss_sum);
    let squared_residual = |(s, t): &(f64, f64)| (t - offset - slope * s).powi(2);
    let residual_sum: f64 = edge_points.iter().map(squared_residual).sum();
    if (residual_sum / profile_count as f64).sqrt() > MAX_RMS_DEVIATION {
        return None;
    }
    let half_length = length / 2.0;
    let line = Line {
        point: std::array::from_fn(|i| from[i] + half_length * along[i] + offset * normal[i]),
        direction: std::array::from_fn(|i| along[i] + slope * normal[i]),
    };
    Some((line, (black + white) / 2.0))
}

/// Returns the intersection of two lines; `None` if they are parallel.
fn intersect(a: &Line, b: &Line) -> Option<Pixel> {
    let cross = a.direction[0] * b.direction[1] - a.direction[1] * b.direction[0];
    let [x, y] = [b.point[0] - a.point[0], b.point[1] - a.point[1]];
    let distance = (x * b.direction[1] - y * b.direction[0]) / cross;
    let point = [0, 1].map(|axis| a.point[axis] + distance * a.direction[axis]);
    point.iter().all(|value| value.is_finite()).then_some(point)
}
