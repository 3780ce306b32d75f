//! Three ways to hang a spring between a servo's crank and its leg.

use lizard_robot::{Coil, Spring};

/// How the leg is pulled along.
#[derive(clap::ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Geometry {
    /// Two springs that pull against each other along the arc of their anchors
    Pair,
    /// One spring in line with the crank: it holds by its tension
    Radial,
    /// A strut with a stop and the spring inside: rigid up to its preload
    #[default]
    Strut,
}

/// A spring where it is hung.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hung {
    pub coil: Coil,
    pub geometry: Geometry,
    /// From the leg's pivot to the spring's anchor on the leg, mm.
    pub radius: f64,
    /// Length of the spring inside its hooks when the leg does not lag, mm.
    pub installed: f64,
}

impl Hung {
    /// Its force when the leg does not lag, N.
    pub fn force(&self) -> f64 {
        self.coil.force(self.installed)
    }

    /// What the leg feels of it.
    pub fn spring(&self) -> Spring {
        let (rate, radius) = (self.coil.rate(), self.radius);
        // N mm per radian.
        let (per_radian, preload) = match self.geometry {
            // One gets longer by what the other gets shorter.
            Geometry::Pair => (2.0 * rate * radius * radius, 0.0),
            // Anchors in line with the pivot, one `installed` further out: turned by z,
            // the pull has a lever of both radii over their distance, times sin z.
            Geometry::Radial => {
                let outer = radius + self.installed;
                (self.force() * radius * outer / self.installed, 0.0)
            }
            // Up to the preload the strut stands at its stop.
            Geometry::Strut => (rate * radius * radius, self.force() * radius),
        };
        Spring {
            rate: per_radian.to_radians(),
            preload,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COIL: Coil = Coil::paper(0.6);

    fn hung(geometry: Geometry) -> Hung {
        Hung {
            coil: COIL,
            geometry,
            radius: 20.0,
            installed: 30.0,
        }
    }

    /// Torque of a spring between two points at angles of the same pivot, N mm, by
    /// differences of its energy.
    fn torque(coil: Coil, inner: f64, outer: f64, angle: f64) -> f64 {
        let energy = |angle: f64| {
            let length = (inner * inner + outer * outer - 2.0 * inner * outer * angle.cos()).sqrt();
            let stretch = length - coil.length;
            coil.initial_tension() * stretch + coil.rate() * stretch * stretch / 2.0
        };
        (energy(angle + 1e-5) - energy(angle - 1e-5)) / 2e-5
    }

    #[test]
    fn a_radial_spring_holds_by_its_tension() {
        let spring = hung(Geometry::Radial).spring();
        let degree = 1f64.to_radians();
        let torque = torque(COIL, 20.0, 50.0, degree);
        assert!(
            (torque / spring.rate - 1.0).abs() < 0.01,
            "{torque} {spring:?}"
        );
        assert_eq!(spring.preload, 0.0);
    }

    #[test]
    fn a_pair_doubles_the_rate_and_a_strut_holds_before_it_yields() {
        let (pair, strut) = (
            hung(Geometry::Pair).spring(),
            hung(Geometry::Strut).spring(),
        );
        assert!((pair.rate - 2.0 * strut.rate).abs() < 1e-12);
        assert!((strut.rate - (COIL.rate() * 400.0).to_radians()).abs() < 1e-12);
        assert!((strut.preload - 20.0 * COIL.force(30.0)).abs() < 1e-9);
    }
}
