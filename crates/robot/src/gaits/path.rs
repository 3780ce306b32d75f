//! The closed curve along which a gait leads the point of head or tail.

use lizard_kinematics::Vector;

use crate::gaits::harmonic::Harmonic;

/// A closed curve: in each coordinate a centre and a sum of harmonics, mm from
/// the middle of the base, outward positive in y.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The mean point.
    pub centre: [f64; 2],
    /// Terms across.
    pub x: Vec<Harmonic>,
    /// Terms outward.
    pub y: Vec<Harmonic>,
}

impl Path {
    /// The point at a phase of 0 to 1, mm.
    pub fn at(&self, phase: f64) -> Vector {
        let sum = |terms: &[Harmonic]| terms.iter().map(|term| term.at(phase)).sum::<f64>();
        Vector::new(self.centre[0] + sum(&self.x), self.centre[1] + sum(&self.y))
    }
}
