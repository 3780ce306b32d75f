//! Mass, mass centre and inertia of a body, from the triangles of its surface.
//!
//! Each triangle makes a tetrahedron with the origin, whose signed volume and moments
//! have closed forms; summed over a closed surface, they are the body's volume and moments.

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
    /// The moments of the volume that a surface encloses, at 1 g/mm^3.
    pub fn of(mesh: &Mesh) -> Self {
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
                    let products = a[i] * a[j] + b[i] * b[j] + c[i] * c[j];
                    sum.second_moments[i][j] +=
                        volume * (corner_sum[i] * corner_sum[j] + products) / 20.0;
                }
            }
        }
        sum
    }

    /// A point mass at the origin; `mass` in g.
    pub fn point_mass(mass: f64) -> Self {
        Self {
            mass,
            ..Self::default()
        }
    }

    /// The moments of the body with its density multiplied by a factor.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.mass *= factor;
        self.first_moments = self.first_moments.map(|component| component * factor);
        self.second_moments = self
            .second_moments
            .map(|row| row.map(|component| component * factor));
        self
    }

    /// The moments of the body after a translation by an offset, mm.
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

    /// The moments of this body and another one together.
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

    /// The mass centre, mm.
    pub fn mass_centre(&self) -> [f64; 3] {
        self.first_moments.map(|component| component / self.mass)
    }

    /// The inertia about the mass centre, g mm^2: xx, yy, zz, xy, xz, yz. The products have the sign that they have
    /// in the inertia tensor.
    pub fn tensor(&self) -> [f64; 6] {
        let centre = self.mass_centre();
        let central_moment_of =
            |i: usize, j: usize| self.second_moments[i][j] - self.mass * centre[i] * centre[j];
        let [x, y, z] = [0, 1, 2].map(|i| central_moment_of(i, i));
        let [xy, xz, yz] = [
            central_moment_of(0, 1),
            central_moment_of(0, 2),
            central_moment_of(1, 2),
        ];
        [y + z, x + z, x + y, -xy, -xz, -yz]
    }

    /// Formats [`Self::tensor`] in kg m^2, as the model files write numbers.
    pub fn formatted_tensor(&self) -> [String; 6] {
        // kg m^2 per g mm^2.
        const KG_M2_PER_G_MM2: f64 = 1e-9;
        self.tensor()
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

    fn inertia_of(filled: Shape, z: [f64; 2]) -> Inertia {
        let (filled, cut) = (vec![filled], Vec::new());
        Inertia::of(&Mesh::of(&Solid::of(&[Prism::new(filled, cut, z)])))
    }

    #[test]
    fn a_box_has_the_mass_centre_and_the_inertia_of_the_closed_forms() {
        let (middle, size) = (Vector::new(7.0, -3.0), Vector::new(20.0, 10.0));
        let inertia = inertia_of(Shape::rectangle(middle, size, 0.0), [2.0, 6.0]);
        assert!((inertia.mass - 800.0).abs() < 1e-9);
        for (component, expected) in inertia.mass_centre().into_iter().zip([7.0, -3.0, 4.0]) {
            assert!((component - expected).abs() < 1e-9);
        }
        let twelfth_of_mass = 800.0 / 12.0;
        let expected = [
            twelfth_of_mass * 116.0,
            twelfth_of_mass * 416.0,
            twelfth_of_mass * 500.0,
            0.0,
            0.0,
            0.0,
        ];
        for (component, expected) in inertia.tensor().into_iter().zip(expected) {
            assert!(
                (component - expected).abs() < 1e-6,
                "{component} {expected}"
            );
        }
    }

    #[test]
    fn translated_moments_equal_those_of_the_body_at_the_new_place() {
        let block_at = |x: f64, y: f64, z: f64| {
            let (middle, size) = (Vector::new(x, y), Vector::new(20.0, 10.0));
            inertia_of(Shape::rectangle(middle, size, 0.0), [z, z + 4.0])
        };
        let (translated_block, expected_block) = (
            block_at(7.0, -3.0, 2.0).translated([-9.0, 5.0, 1.0]),
            block_at(-2.0, 2.0, 3.0),
        );
        let pairs = translated_block
            .mass_centre()
            .into_iter()
            .zip(expected_block.mass_centre());
        let pairs = pairs.chain(
            translated_block
                .tensor()
                .into_iter()
                .zip(expected_block.tensor()),
        );
        for (component, expected) in pairs {
            assert!(
                (component - expected).abs() < 1e-6,
                "{component} {expected}"
            );
        }
    }

    #[test]
    fn two_halves_at_half_the_density_have_half_the_inertia_of_the_whole() {
        let block_of = |x: f64, length: f64| {
            let (middle, size) = (Vector::new(x, 1.0), Vector::new(length, 8.0));
            inertia_of(Shape::rectangle(middle, size, 0.0), [0.0, 3.0])
        };
        let whole_block = block_of(5.0, 20.0);
        let two_halves = block_of(0.0, 10.0).plus(&block_of(10.0, 10.0)).scaled(0.5);
        assert!((two_halves.mass - whole_block.mass / 2.0).abs() < 1e-9);
        for (component, expected) in two_halves.tensor().into_iter().zip(whole_block.tensor()) {
            assert!(
                (component - expected / 2.0).abs() < 1e-6,
                "{component} {expected}"
            );
        }
    }
}
