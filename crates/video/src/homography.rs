//! The map from a plane to its image, computed from four or more points.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// A projective map from one plane to another, as a matrix of homogeneous coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Homography(pub Matrix3<f64>);

impl Homography {
    /// Creates the map that fits four or more pairs of points best, by linear least squares; `None` if the points do
    /// not determine it.
    pub(crate) fn from_points(from: &[[f64; 2]], to: &[[f64; 2]]) -> Option<Self> {
        let rows = 2 * from.len().min(to.len());
        let mut matrix = DMatrix::<f64>::zeros(rows, 8);
        let mut right_hand_side = DVector::zeros(rows);
        // The points are scaled to at most 1, so that the columns are of similar size.
        let coordinates = from.iter().flatten();
        let scale = coordinates.fold(1e-9f64, |max, value| max.max(value.abs()));
        for (i, (&[x, y], &[u, v])) in from.iter().zip(to).enumerate() {
            let [x, y] = [x / scale, y / scale];
            let equations = [
                ([x, y, 1.0, 0.0, 0.0, 0.0, -u * x, -u * y], u),
                ([0.0, 0.0, 0.0, x, y, 1.0, -v * x, -v * y], v),
            ];
            for (j, (row, target)) in equations.into_iter().enumerate() {
                matrix.row_mut(2 * i + j).copy_from_slice(&row);
                right_hand_side[2 * i + j] = target;
            }
        }
        let solution = if rows == 8 {
            matrix.lu().solve(&right_hand_side)?
        } else {
            matrix.svd(true, true).solve(&right_hand_side, 1e-12).ok()?
        };
        let h = &solution;
        let map = Matrix3::new(h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1.0);
        let map = map * Matrix3::from_diagonal(&Vector3::new(1.0 / scale, 1.0 / scale, 1.0));
        let is_finite = map.iter().all(|value| value.is_finite());
        is_finite.then_some(Self(map))
    }

    /// Returns the image of a point.
    pub(crate) fn map(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let image = self.0 * Vector3::new(x, y, 1.0);
        [image.x / image.z, image.y / image.z]
    }

    /// Returns the inverse map; `None` if the map is singular.
    pub(crate) fn inverse(&self) -> Option<Self> {
        self.0.try_inverse().map(Self)
    }
}
