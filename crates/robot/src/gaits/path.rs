//! The closed curve along which a gait leads the point of head or tail.

use std::f64::consts::TAU;

use lizard_kinematics::Vector;

/// One term of a path's coordinate: `amplitude * sin(2 pi (k phase + shift))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Periods in a cycle, a whole number so that the path closes.
    pub k: f64,
    /// Amplitude, mm.
    pub amplitude: f64,
    /// Shift of the phase, in periods of this term.
    pub shift: f64,
}

/// A closed curve: in each coordinate a centre and a sum of harmonics, mm from
/// the middle of the base, outward positive in y.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The mean point, mm.
    pub centre: [f64; 2],
    /// Terms of the coordinate across.
    pub x: Vec<Harmonic>,
    /// Terms of the coordinate outward.
    pub y: Vec<Harmonic>,
}

impl Path {
    /// The point at a phase of 0 to 1, mm.
    pub fn at(&self, phase: f64) -> Vector {
        let sum = |terms: &[Harmonic]| {
            let value =
                |term: &Harmonic| term.amplitude * (TAU * (term.k * phase + term.shift)).sin();
            terms.iter().map(value).sum::<f64>()
        };
        Vector::new(self.centre[0] + sum(&self.x), self.centre[1] + sum(&self.y))
    }
}
