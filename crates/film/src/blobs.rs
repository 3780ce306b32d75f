//! The dark blobs of a picture, and the four corners of those that are quadrilaterals.
//!
//! Light falls unevenly and a floor may be dark, so a pixel counts as dark by comparison with the mean of its
//! surroundings. A tag has a black frame with white around it: its dark pixels are connected to each other and to no
//! others.

use crate::picture::{Picture, Pixel};

/// Half the edge of the square of surroundings with which a pixel is compared, as a share of the picture's height.
const REACH_SHARE: f64 = 1.0 / 24.0;
/// Largest grey of a dark pixel, percent of the mean of its surroundings.
const DARK_PERCENT: u32 = 88;
/// Smallest width and height of a candidate blob, px: two for each square of a tag.
const MIN_SIDE: usize = 16;
/// Smallest distance of a corner from the other diagonal, as a share of that diagonal.
const MIN_SLIMNESS: f64 = 0.15;
/// Smallest and largest ratio of a blob's pixel count to the area of its quadrilateral.
const FILL_RATIOS: [f64; 2] = [0.3, 1.2];

/// Four corners, accurate to some pixels, clockwise as seen in the picture.
pub(crate) type Quad = [Pixel; 4];

/// Half the edge of the square of surroundings with which a pixel is compared, px.
pub(crate) fn reach(picture: &Picture) -> usize {
    let [_, height] = picture.size();
    ((height as f64 * REACH_SHARE) as usize).max(MIN_SIDE / 2)
}

/// Finds the dark blobs that are nearly quadrilaterals. A pixel is compared with its surroundings up to `reach` px
/// on each side.
pub(crate) fn quads(picture: &Picture, reach: usize) -> Vec<Quad> {
    let [width, height] = picture.size();
    let mut is_dark = find_dark_pixels(picture, reach);
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
            let mut visit = |next: usize| {
                if is_dark[next] {
                    is_dark[next] = false;
                    to_visit.push(next);
                }
            };
            if column > 0 {
                visit(index - 1);
            }
            if column + 1 < width {
                visit(index + 1);
            }
            if index >= width {
                visit(index - width);
            }
            if index + width < width * height {
                visit(index + width);
            }
        }
        quads.extend(corners_of(&blob, width, height));
    }
    quads
}

/// True for each pixel that is darker than its surroundings.
fn find_dark_pixels(picture: &Picture, reach: usize) -> Vec<bool> {
    let [width, height] = picture.size();
    // The sums of all pixels above and to the left; the table is one wider and higher than the picture.
    let mut sums = vec![0u32; (width + 1) * (height + 1)];
    for (y, row) in picture.grey().chunks(width).enumerate() {
        let mut sum = 0u32;
        for (x, grey) in row.iter().enumerate() {
            sum += u32::from(*grey);
            sums[(y + 1) * (width + 1) + x + 1] = sums[y * (width + 1) + x + 1].wrapping_add(sum);
        }
    }
    let mut dark = Vec::with_capacity(width * height);
    for (y, row) in picture.grey().chunks(width).enumerate() {
        let (top, bottom) = (y.saturating_sub(reach), (y + reach + 1).min(height));
        let (above, below) = (top * (width + 1), bottom * (width + 1));
        for (x, grey) in row.iter().enumerate() {
            let (left, right) = (x.saturating_sub(reach), (x + reach + 1).min(width));
            // Large sums wrap around, but their differences are correct.
            let sum = sums[below + right]
                .wrapping_sub(sums[below + left])
                .wrapping_sub(sums[above + right])
                .wrapping_add(sums[above + left]);
            let count = ((right - left) * (bottom - top)) as u32;
            dark.push(
                u64::from(*grey) * u64::from(count) * 100
                    < u64::from(sum) * u64::from(DARK_PERCENT),
            );
        }
    }
    dark
}

/// The corners of a blob; `None` if it is small, reaches the picture's border, or is not nearly a quadrilateral.
fn corners_of(blob: &[usize], width: usize, height: usize) -> Option<Quad> {
    if blob.len() < MIN_SIDE * MIN_SIDE / 4 {
        return None;
    }
    let pixel_of = |index: usize| [(index % width) as f64, (index / width) as f64];
    let (mut low, mut high) = ([f64::INFINITY; 2], [0.0f64; 2]);
    for &index in blob {
        let pixel = pixel_of(index);
        for i in 0..2 {
            low[i] = low[i].min(pixel[i]);
            high[i] = high[i].max(pixel[i]);
        }
    }
    let is_inside = low[0] > 0.0
        && low[1] > 0.0
        && high[0] < (width - 1) as f64
        && high[1] < (height - 1) as f64;
    let is_large = (0..2).all(|i| high[i] - low[i] >= MIN_SIDE as f64);
    if !is_inside || !is_large {
        return None;
    }
    let farthest_by = |measure: &dyn Fn(Pixel) -> f64| {
        let distances = blob.iter().map(|&index| (measure(pixel_of(index)), index));
        distances.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let distance_from = |[x, y]: Pixel| move |[u, v]: Pixel| (u - x).hypot(v - y);
    let middle = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0];
    let a = pixel_of(farthest_by(&distance_from(middle))?.1);
    let (diagonal, c) = farthest_by(&distance_from(a))?;
    let c = pixel_of(c);
    // Positive to the right of the line from a to c as seen in the picture, where y is down.
    let signed_distance =
        |[x, y]: Pixel| ((c[0] - a[0]) * (y - a[1]) - (c[1] - a[1]) * (x - a[0])) / diagonal;
    let (left, b) = farthest_by(&|point| -signed_distance(point))?;
    let (right, d) = farthest_by(&signed_distance)?;
    if left.min(right) < MIN_SLIMNESS * diagonal {
        return None;
    }
    let fill_ratio = blob.len() as f64 / (diagonal * (left + right) / 2.0);
    let is_filled = (FILL_RATIOS[0]..FILL_RATIOS[1]).contains(&fill_ratio);
    is_filled.then_some([a, pixel_of(b), c, pixel_of(d)])
}
