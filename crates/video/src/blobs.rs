//! Finds the dark quadrilaterals in a frame.
//!
//! Light falls unevenly and a floor may be dark, so each pixel is compared with the mean of its surroundings. A tag has
//! a black border with a white margin around it. Its dark pixels therefore form a connected region of their own, a
//! blob.

use crate::frame::{Frame, Pixel};

/// Half the edge of the window whose mean a pixel is compared with, as a fraction of the frame's height.
const HALF_WINDOW_FRACTION: f64 = 1.0 / 24.0;
/// Largest grey of a dark pixel, percent of its window's mean.
const MAX_DARK_PERCENT: u64 = 88;
/// Smallest width and height of a candidate blob, px: two pixels for each cell of a tag.
const MIN_SIDE_PX: usize = 16;
/// Smallest distance of the other two corners from the longest diagonal, as a fraction of the diagonal.
const MIN_CORNER_DISTANCE_FRACTION: f64 = 0.15;
/// Smallest and largest ratio of a blob's pixel count to the area of its quadrilateral.
const FILL_RATIO_RANGE: [f64; 2] = [0.3, 1.2];

/// The four corners of a quadrilateral, clockwise as seen in the frame, with errors of a few pixels.
pub(crate) type Quad = [Pixel; 4];

/// Returns half the edge of the window whose mean a pixel is compared with, px.
pub(crate) fn half_window(frame: &Frame) -> usize {
    let [_, height] = frame.size();
    ((height as f64 * HALF_WINDOW_FRACTION) as usize).max(MIN_SIDE_PX / 2)
}

/// Finds the dark blobs that are roughly quadrilateral. Each pixel is compared with the mean of a window that extends
/// `half_window` px to each side.
pub(crate) fn find_quads(frame: &Frame, half_window: usize) -> Vec<Quad> {
    let [width, height] = frame.size();
    let mut is_dark = find_dark_pixels(frame, half_window);
    let mut quads = Vec::new();
    let (mut blob, mut to_visit) = (Vec::new(), Vec::new());
    for start in 0..is_dark.len() {
        if !is_dark[start] {
            continue;
        }
        blob.clear();
        is_dark[start] = false;
        to_visit.push(start);
        while let Some(index) = to_visit.pop() {
            blob.push(index);
            let column = index % width;
            let neighbours = [
                (column > 0).then(|| index - 1),
                (column + 1 < width).then_some(index + 1),
                index.checked_sub(width),
                (index + width < is_dark.len()).then_some(index + width),
            ];
            for next in neighbours.into_iter().flatten() {
                if is_dark[next] {
                    is_dark[next] = false;
                    to_visit.push(next);
                }
            }
        }
        quads.extend(find_corners(&blob, [width, height]));
    }
    quads
}

/// Finds the dark pixels: true for each pixel whose grey is below `MAX_DARK_PERCENT` of its window's mean.
fn find_dark_pixels(frame: &Frame, half_window: usize) -> Vec<bool> {
    let [width, height] = frame.size();
    // Each entry is the sum of all pixels above and to the left. The table has one more column and row than the frame.
    let mut integral_image = vec![0u32; (width + 1) * (height + 1)];
    for (y, row) in frame.grey().chunks(width).enumerate() {
        let mut row_sum = 0u32;
        for (x, grey) in row.iter().enumerate() {
            row_sum += u32::from(*grey);
            integral_image[(y + 1) * (width + 1) + x + 1] =
                integral_image[y * (width + 1) + x + 1].wrapping_add(row_sum);
        }
    }
    let mut is_dark = Vec::with_capacity(width * height);
    let window_range = |centre: usize, length: usize| {
        let end = (centre + half_window + 1).min(length);
        (centre.saturating_sub(half_window), end)
    };
    for (y, row) in frame.grey().chunks(width).enumerate() {
        let (top, bottom) = window_range(y, height);
        let (above, below) = (top * (width + 1), bottom * (width + 1));
        for (x, grey) in row.iter().enumerate() {
            let (left, right) = window_range(x, width);
            // Large sums wrap around, but their differences are correct.
            let window_sum = integral_image[below + right]
                .wrapping_sub(integral_image[below + left])
                .wrapping_sub(integral_image[above + right])
                .wrapping_add(integral_image[above + left]);
            let window_area = ((right - left) * (bottom - top)) as u64;
            let max_dark_sum = u64::from(window_sum) * MAX_DARK_PERCENT;
            is_dark.push(u64::from(*grey) * window_area * 100 < max_dark_sum);
        }
    }
    is_dark
}

/// Finds the corners of a blob; `None` if the blob is small, touches the frame's border, or is not a quadrilateral.
fn find_corners(blob: &[usize], frame_size: [usize; 2]) -> Option<Quad> {
    if blob.len() < MIN_SIDE_PX * MIN_SIDE_PX / 4 {
        return None;
    }
    let width = frame_size[0];
    let to_pixel = |index: usize| [(index % width) as f64, (index / width) as f64];
    let (mut min, mut max) = ([f64::INFINITY; 2], [0.0f64; 2]);
    for &index in blob {
        let pixel = to_pixel(index);
        for i in 0..2 {
            min[i] = min[i].min(pixel[i]);
            max[i] = max[i].max(pixel[i]);
        }
    }
    let is_inside = (0..2).all(|i| min[i] > 0.0 && max[i] < (frame_size[i] - 1) as f64);
    let is_large = (0..2).all(|i| max[i] - min[i] >= MIN_SIDE_PX as f64);
    if !is_inside || !is_large {
        return None;
    }
    let farthest_by = |distance: &dyn Fn(Pixel) -> f64| {
        let pairs = blob.iter().map(|&index| (distance(to_pixel(index)), index));
        pairs.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let distance_from = |[x, y]: Pixel| move |[u, v]: Pixel| (u - x).hypot(v - y);
    let centre = [(min[0] + max[0]) / 2.0, (min[1] + max[1]) / 2.0];
    let a = to_pixel(farthest_by(&distance_from(centre))?.1);
    let (diagonal, c) = farthest_by(&distance_from(a))?;
    let c = to_pixel(c);
    // Positive on the right of the line from a to c as seen in the frame, whose y axis points down.
    let signed_distance =
        |[x, y]: Pixel| ((c[0] - a[0]) * (y - a[1]) - (c[1] - a[1]) * (x - a[0])) / diagonal;
    let (left, b) = farthest_by(&|point| -signed_distance(point))?;
    let (right, d) = farthest_by(&signed_distance)?;
    if left.min(right) < MIN_CORNER_DISTANCE_FRACTION * diagonal {
        return None;
    }
    let fill_ratio = blob.len() as f64 / (diagonal * (left + right) / 2.0);
    let is_filled = (FILL_RATIO_RANGE[0]..FILL_RATIO_RANGE[1]).contains(&fill_ratio);
    is_filled.then_some([a, to_pixel(b), c, to_pixel(d)])
}
