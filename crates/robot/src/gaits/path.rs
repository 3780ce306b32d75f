//! The closed curve along which a gait moves the end point of the head or the tail.

use std::f64::consts::TAU;

use lizard_kinematics::Vector;

/// One harmonic of a path's coordinate: `amplitude * sin(2 pi (order * phase + phase_shift))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Order of the harmonic: the number of its periods in a cycle, a whole number so that the path closes.
    pub order: f64,
    /// Amplitude of the harmonic, mm.
    pub amplitude: f64,
    /// Phase shift, in periods of this harmonic.
    pub phase_shift: f64,
}

/// A closed curve: a centre plus a sum of harmonics in each coordinate. The coordinates are in mm from the middle of
/// the base, which is the line between the end's two servo shafts; positive y points outward.
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
    /// Returns the point at `phase` (0 to 1), mm.
    pub fn point_at(&self, phase: f64) -> Vector {
        let value = |harmonic: &Harmonic| {
            let angle = TAU * (harmonic.order * phase + harmonic.phase_shift);
            harmonic.amplitude * angle.sin()
        };
        let sum = |harmonics: &[Harmonic]| harmonics.iter().map(value).sum::<f64>();
        Vector::new(self.centre[0] + sum(&self.x), self.centre[1] + sum(&self.y))
    }
}
