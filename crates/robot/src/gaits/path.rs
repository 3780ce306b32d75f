//! The closed curve along which a gait moves the end point of the head or the tail.

use std::f64::consts::TAU;

use lizard_kinematics::Vector;

/// One harmonic of a path's coordinate: `amplitude * sin(2 pi (k phase + shift))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Order of the harmonic: its number of periods in a cycle, a whole number so that the path closes.
    pub k: f64,
    /// Amplitude, mm.
    pub amplitude: f64,
    /// Phase shift, in periods of this harmonic.
    pub shift: f64,
}

/// A closed curve: a centre plus a sum of harmonics in each coordinate. The coordinates are in mm from the middle of
/// the base; y is positive outward.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The mean point, mm.
    pub centre: [f64; 2],
    /// Harmonics of the lateral coordinate.
    pub x: Vec<Harmonic>,
    /// Harmonics of the outward coordinate.
    pub y: Vec<Harmonic>,
}

impl Path {
    /// The point at a phase of 0 to 1, mm.
    pub fn point_at(&self, phase: f64) -> Vector {
        let sum_of = |terms: &[Harmonic]| {
            let value_of =
                |term: &Harmonic| term.amplitude * (TAU * (term.k * phase + term.shift)).sin();
            terms.iter().map(value_of).sum::<f64>()
        };
        Vector::new(
            self.centre[0] + sum_of(&self.x),
            self.centre[1] + sum_of(&self.y),
        )
    }
}
