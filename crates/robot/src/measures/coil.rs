//! A close-wound tension spring of round wire.

use std::f64::consts::PI;

/// Shear modulus of spring steel, N/mm^2.
const SHEAR: f64 = 79_300.0;

/// A tension spring with the dimensions that a shop gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coil {
    /// Diameter of the wire, mm.
    pub wire: f64,
    /// Outer diameter of the coil, mm.
    pub outer: f64,
    /// Length inside its hooks without load, mm.
    pub length: f64,
}

impl Coil {
    /// A spring of the paper's size with a wire of this diameter, mm.
    pub const fn paper(wire: f64) -> Self {
        Self {
            wire,
            outer: 5.55,
            length: 25.4,
        }
    }

    /// Mean diameter of the coil, mm.
    pub fn mean_diameter(&self) -> f64 {
        self.outer - self.wire
    }

    /// Number of active coils. The wound body is as long as the spring without its two hooks;
    /// each hook is an inner diameter long.
    pub fn coils(&self) -> f64 {
        let inner_diameter = self.outer - 2.0 * self.wire;
        (self.length - 2.0 * inner_diameter) / self.wire - 1.0
    }

    /// Rate, N/mm: G d^4 / (8 D^3 n).
    pub fn rate(&self) -> f64 {
        SHEAR * self.wire.powi(4) / (8.0 * self.mean_diameter().powi(3) * self.coils())
    }

    /// Initial tension: the force that opens the coils, N. Winding leaves a shear stress that falls with
    /// C, the ratio of the coil's mean diameter to the wire's. Makers reach 231 / e^(0.105 C) MPa, plus or
    /// minus 6.9 (4 - (C - 3) / 6.5) MPa.
    pub fn initial_tension(&self) -> f64 {
        let ratio = self.mean_diameter() / self.wire;
        self.force_at_stress(231.0 * (-0.105 * ratio).exp())
    }

    /// Force at a length inside the hooks, N.
    pub fn force(&self, length: f64) -> f64 {
        self.initial_tension() + self.rate() * (length - self.length).max(0.0)
    }

    /// Shear stress at a force, N/mm^2.
    pub fn stress(&self, force: f64) -> f64 {
        force / self.force_at_stress(1.0)
    }

    /// Force at a shear stress in N/mm^2, N.
    fn force_at_stress(&self, stress: f64) -> f64 {
        PI * self.wire.powi(3) * stress / (8.0 * self.mean_diameter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coil_has_the_rate_of_the_handbook() {
        // d 1, D 10, n 20: 79300 / (8 * 1000 * 20) = 0.4956 N/mm.
        let coil = Coil {
            wire: 1.0,
            outer: 11.0,
            length: 2.0 * 9.0 + 21.0,
        };
        assert!((coil.coils() - 20.0).abs() < 1e-9);
        assert!((coil.rate() - 0.495_625).abs() < 1e-6);
        // C = 10: the stress is 231 / e^1.05 = 80.8 MPa, and the force pi d^3 / (8 D) = pi / 80 times as many N.
        assert!(
            (coil.initial_tension() - 3.174).abs() < 0.01,
            "{}",
            coil.initial_tension()
        );
        assert!((coil.stress(coil.initial_tension()) - 80.8).abs() < 0.1);
        let force_change = coil.force(coil.length + 4.0) - coil.force(coil.length);
        assert!((force_change - 4.0 * 0.495_625).abs() < 1e-9);
        assert_eq!(coil.force(0.0), coil.initial_tension());
    }
}
