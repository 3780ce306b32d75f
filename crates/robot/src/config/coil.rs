//! A close-wound tension spring of round wire.

use std::f64::consts::PI;

/// Shear modulus of spring steel, N/mm^2.
const SHEAR_MODULUS: f64 = 79_300.0;

/// A tension spring, described by the dimensions that shops state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coil {
    /// Diameter of the wire, mm.
    pub wire_diameter: f64,
    /// Outer diameter of the coil, mm.
    pub outer_diameter: f64,
    /// Free length: from inside hook to inside hook without load, mm.
    pub free_length: f64,
}

impl Coil {
    /// Mean diameter of the coil, mm.
    pub fn mean_diameter(&self) -> f64 {
        self.outer_diameter - self.wire_diameter
    }

    /// Number of active coils. The wound body is as long as the spring without the two hooks, each of which is an inner
    /// diameter long.
    pub fn active_coil_count(&self) -> f64 {
        let inner_diameter = self.outer_diameter - 2.0 * self.wire_diameter;
        (self.free_length - 2.0 * inner_diameter) / self.wire_diameter - 1.0
    }

    /// Spring rate, N/mm: G d^4 / (8 D^3 n), with the shear modulus G, the wire diameter d, the mean coil diameter D,
    /// and n active coils.
    pub fn rate(&self) -> f64 {
        SHEAR_MODULUS * self.wire_diameter.powi(4)
            / (8.0 * self.mean_diameter().powi(3) * self.active_coil_count())
    }

    /// Initial tension: the force that opens the coils, N. The wire keeps a shear stress from the winding. The stress
    /// falls with C, the ratio of the mean coil diameter to the wire diameter. Makers reach 231 / e^(0.105 C) MPa, plus
    /// or minus 6.9 (4 - (C - 3) / 6.5) MPa.
    pub fn initial_tension(&self) -> f64 {
        let ratio = self.mean_diameter() / self.wire_diameter;
        self.force_at_stress(231.0 * (-0.105 * ratio).exp())
    }

    /// Force at a length between the insides of the hooks (mm), N; 0 if the spring is slack.
    pub fn force(&self, length: f64) -> f64 {
        match length - self.free_length {
            ..0.0 => 0.0,
            extension => self.initial_tension() + self.rate() * extension,
        }
    }

    /// Force at a shear stress of the wire (N/mm^2), N.
    fn force_at_stress(&self, stress: f64) -> f64 {
        PI * self.wire_diameter.powi(3) * stress / (8.0 * self.mean_diameter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::assert_near;

    #[test]
    fn rate_initial_tension_and_stress_agree_with_the_handbook() {
        // d 1, D 10, n 20: 79300 / (8 * 1000 * 20) = 0.4956 N/mm.
        let coil = Coil {
            wire_diameter: 1.0,
            outer_diameter: 11.0,
            free_length: 2.0 * 9.0 + 21.0,
        };
        assert_near(coil.active_coil_count(), 20.0, 1e-9);
        assert_near(coil.rate(), 0.495_625, 1e-6);
        // C = 10: the stress is 231 / e^1.05 = 80.8 MPa, and the force pi d^3 / (8 D) = pi / 80 times as many N.
        assert_near(coil.initial_tension(), 3.174, 0.01);
        let initial_stress = coil.initial_tension() / coil.force_at_stress(1.0);
        assert_near(initial_stress, 80.8, 0.1);
        let force_change = coil.force(coil.free_length + 4.0) - coil.force(coil.free_length);
        assert_near(force_change, 4.0 * 0.495_625, 1e-9);
        assert_eq!(coil.force(coil.free_length), coil.initial_tension());
        assert_eq!(coil.force(coil.free_length - 0.1), 0.0);
    }
}
