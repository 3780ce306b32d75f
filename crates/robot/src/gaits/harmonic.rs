//! One sine of a closed curve.

use std::f64::consts::TAU;

/// One term of a path's coordinate: `amplitude * sin(2 pi (k phase + shift))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Whole periods in a cycle, so that the path closes.
    pub k: f64,
    /// mm.
    pub amplitude: f64,
    /// In periods of the term.
    pub shift: f64,
}

impl Harmonic {
    /// The term's value at a phase, mm.
    pub fn at(&self, phase: f64) -> f64 {
        self.amplitude * (TAU * (self.k * phase + self.shift)).sin()
    }
}
