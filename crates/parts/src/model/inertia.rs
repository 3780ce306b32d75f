//! Mass, centre of mass and inertia of a body, from the triangles of its surface.
//!
//! Each triangle forms a tetrahedron with the origin. The signed volumes and moments of these tetrahedra have closed
//! forms; their sums over a closed surface are the body's volume and moments.

use crate::files::mesh::Mesh;

/// Moments of order 0, 1 and 2 of a mass distribution about the origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Inertia {
    /// Mass, g.
    pub mass: f64,
    /// First moments: mass times position, g mm.
    first_moments: [f64; 3],
    /// Second moments: mass times the products of the position's components, g mm^2.
    second_moments: [[f64; 3]; 3],
}

impl Inertia {
    /// Computes the moments of the volume within a surface, at 1 g/mm^3.
    pub fn from_mesh(mesh: &Mesh) -> Self {
        let mut sum = Self::default();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|corner| mesh.corners[corner]);
            let volume = (a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
                / 6.0;
            sum.mass += volume;
            let corner_sum = [0, 1, 2].map(|i| a[i] + b[i] + c[i]);
            for i in 0..3 {
                sum.first_moments[i] += volume * corner_sum[i] / 4.0;
                for j in 0..3 {
                    let product_sum = a[i] * a[j] + b[i] * b[j] + c[i] * c[j];
                    sum.second_moments[i][j] +=
                        volume * (corner_sum[i] * corner_sum[j] + product_sum) / 20.0;
                }
            }
        }
        sum
    }

    /// Creates a point mass at the origin; `mass` in g.
    pub fn point_mass(mass: f64) -> Self {
        Self {
            mass,
            ..Self::default()
        }
    }

    /// Returns the moments at `factor` times the density.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.mass *= factor;
        let scale = |component: f64| component * factor;
        self.first_moments = self.first_moments.map(scale);
        self.second_moments = self.second_moments.map(|row| row.map(scale));
        self
    }

    /// Returns the moments after a translation by `offset` (mm).
    pub fn translated(mut self, offset: [f64; 3]) -> Self {
        for i in 0..3 {
            for j in 0..3 {
                self.second_moments[i][j] +=
                    offset[i] * self.first_moments[j] + self.first_moments[i] * offset[j];
                self.second_moments[i][j] += self.mass * offset[i] * offset[j];
            }
        }
        for (first_moment, offset) in self.first_moments.iter_mut().zip(offset) {
            *first_moment += self.mass * offset;
        }
        self
    }

    /// Returns the moments of this body together with another body.
    pub fn plus(mut self, other: &Self) -> Self {
        self.mass += other.mass;
        for i in 0..3 {
            self.first_moments[i] += other.first_moments[i];
            for j in 0..3 {
                self.second_moments[i][j] += other.second_moments[i][j];
            }
        }
        self
    }

    /// Centre of mass, mm.
    pub fn centre_of_mass(&self) -> [f64; 3] {
        self.first_moments.map(|component| component / self.mass)
    }

    /// Computes the inertia tensor about the centre of mass, g mm^2: xx, yy, zz, xy, xz, yz.
    pub fn compute_tensor(&self) -> [f64; 6] {
        let centre = self.centre_of_mass();
        let central_moment =
            |i: usize, j: usize| self.second_moments[i][j] - self.mass * centre[i] * centre[j];
        let [x, y, z] = [0, 1, 2].map(|i| central_moment(i, i));
        let [xy, xz, yz] = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| central_moment(i, j));
        [y + z, x + z, x + y, -xy, -xz, -yz]
    }

    /// Formats [`Self::compute_tensor`] in kg m^2 for the model files.
    pub fn format_tensor(&self) -> [String; 6] {
        const KG_M2_PER_G_MM2: f64 = 1e-9;
        self.compute_tensor()
            .map(|component| format!("{:.6e}", component * KG_M2_PER_G_MM2))
    }
}

#[cfg(test)]
mod tests {
    use lizard_kinematics::Vector;

    use super::*;
    use crate::files::solid::Solid;
    use crate::layers::body::Prism;
    use crate::layers::shape::Shape;

    fn compute_box_inertia([x, y]: [f64; 2], [width, length]: [f64; 2], z: [f64; 2]) -> Inertia {
        let rectangle = Shape::rectangle(Vector::new(x, y), Vector::new(width, length), 0.0);
        let solid = Solid::from_prisms(&[Prism::solid([rectangle], z)]);
        Inertia::from_mesh(&Mesh::from_solid(&solid))
    }

    #[track_caller]
    fn assert_all_near<const N: usize>(actual: [f64; N], expected: [f64; N], max_error: f64) {
        for (actual, expected) in actual.into_iter().zip(expected) {
            let is_near = (actual - expected).abs() < max_error;
            assert!(is_near, "expected {expected}, got {actual}");
        }
    }

    #[test]
    fn centre_of_mass_and_inertia_of_a_box_match_the_closed_forms() {
        let inertia = compute_box_inertia([7.0, -3.0], [20.0, 10.0], [2.0, 6.0]);
        assert_all_near([inertia.mass], [800.0], 1e-9);
        assert_all_near(inertia.centre_of_mass(), [7.0, -3.0, 4.0], 1e-9);
        let expected =
            [116.0, 416.0, 500.0, 0.0, 0.0, 0.0].map(|square_sum| 800.0 / 12.0 * square_sum);
        assert_all_near(inertia.compute_tensor(), expected, 1e-6);
    }

    #[test]
    fn translated_moments_match_a_body_at_the_new_position() {
        let block = compute_box_inertia([7.0, -3.0], [20.0, 10.0], [2.0, 6.0]);
        let translated = block.translated([-9.0, 5.0, 1.0]);
        let expected = compute_box_inertia([-2.0, 2.0], [20.0, 10.0], [3.0, 7.0]);
        assert_all_near(translated.centre_of_mass(), expected.centre_of_mass(), 1e-6);
        assert_all_near(translated.compute_tensor(), expected.compute_tensor(), 1e-6);
    }

    #[test]
    fn two_halves_at_half_density_have_half_the_inertia_of_the_whole() {
        let build_block =
            |x: f64, width: f64| compute_box_inertia([x, 1.0], [width, 8.0], [0.0, 3.0]);
        let whole = build_block(5.0, 20.0);
        let halves = build_block(0.0, 10.0).plus(&build_block(10.0, 10.0));
        let halves = halves.scaled(0.5);
        assert_all_near([halves.mass], [whole.mass / 2.0], 1e-9);
        let expected = whole.compute_tensor().map(|component| component / 2.0);
        assert_all_near(halves.compute_tensor(), expected, 1e-6);
    }
}
