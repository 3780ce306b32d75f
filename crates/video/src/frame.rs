//! A frame of a video, in shades of grey.

/// A point of a frame, px: to the right and down from the centre of the top left pixel.
pub type Pixel = [f64; 2];

/// A frame of a video in shades of grey: rows from the top, 0 is black.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    width: usize,
    height: usize,
    grey: Vec<u8>,
}

impl Frame {
    /// Creates a frame from its rows; `None` if the length of `grey` is not `width * height`, or is zero.
    pub fn new(width: usize, height: usize, grey: Vec<u8>) -> Option<Self> {
        let is_complete = width.checked_mul(height) == Some(grey.len()) && !grey.is_empty();
        is_complete.then_some(Self {
            width,
            height,
            grey,
        })
    }

    /// Converts a coloured frame to grey. `pixels` has four bytes per pixel: red, green, blue, and an ignored one.
    /// `None` if the length of `pixels` is not `4 * width * height`, or is zero.
    pub fn from_rgba(width: usize, height: usize, pixels: &[u8]) -> Option<Self> {
        let (pixels, remainder) = pixels.as_chunks::<4>();
        let to_grey = |&[red, green, blue, _]: &[u8; 4]| luma(red, green, blue);
        if !remainder.is_empty() {
            return None;
        }
        Self::new(width, height, pixels.iter().map(to_grey).collect())
    }

    /// Returns the part of the frame from `[left, top]` up to `[right, bottom]`, exclusive; `None` if the part is
    /// empty or extends beyond the frame.
    pub(crate) fn crop(
        &self,
        [left, top]: [usize; 2],
        [right, bottom]: [usize; 2],
    ) -> Option<Self> {
        let rows = self.grey.chunks(self.width).take(bottom).skip(top);
        let grey = rows.flat_map(|row| row.get(left..right).unwrap_or_default());
        let (width, height) = (right.checked_sub(left)?, bottom.checked_sub(top)?);
        Self::new(width, height, grey.copied().collect())
    }

    /// Returns the width and the height, px.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// Returns the grey values, row by row from the top.
    pub fn grey(&self) -> &[u8] {
        &self.grey
    }

    /// Returns the grey at a point, interpolated between pixels. Outside the frame, returns the grey of the nearest
    /// point on its edge.
    pub fn grey_at(&self, [x, y]: Pixel) -> f64 {
        let x = x.clamp(0.0, (self.width - 1) as f64);
        let y = y.clamp(0.0, (self.height - 1) as f64);
        let (column, row) = (x as usize, y as usize);
        let right = (column + 1).min(self.width - 1);
        let below = (row + 1).min(self.height - 1);
        let (u, v) = (x - column as f64, y - row as f64);
        let grey = |row: usize, column: usize| f64::from(self.grey[row * self.width + column]);
        (grey(row, column) * (1.0 - u) + grey(row, right) * u) * (1.0 - v)
            + (grey(below, column) * (1.0 - u) + grey(below, right) * u) * v
    }
}

/// Returns the luma of a colour according to BT.601.
pub(crate) fn luma(red: u8, green: u8, blue: u8) -> u8 {
    let sum = 299 * u32::from(red) + 587 * u32::from(green) + 114 * u32::from(blue);
    (sum / 1000) as u8
}
