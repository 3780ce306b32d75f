//! Three ways to hang a spring between a servo's crank and its leg.

use lizard_robot::{Coil, Drive, Kind, Robot, Spring, Strut};

/// How the leg is pulled along.
#[derive(clap::ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Geometry {
    /// Two springs that pull against each other along the arc of their anchors
    Pair,
    /// One spring in line with the crank, which holds by its tension
    Radial,
    /// A strut with a slot and the spring inside: rigid up to its preload; yields only
    /// one way
    #[default]
    Strut,
}

/// A mounted spring.
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

    /// What the legs of a robot are driven by, whose play stays.
    pub fn drive(&self, robot: &Robot) -> Drive {
        let kind = match self.geometry {
            Geometry::Strut => Kind::Strut(self.strut(robot)),
            Geometry::Pair | Geometry::Radial => Kind::Spring(self.ideal()),
        };
        Drive {
            kind,
            ..*robot.drive()
        }
    }

    /// The robot's slotted strut with this spring in it, its anchors at this radius.
    pub fn strut(&self, robot: &Robot) -> Strut {
        Strut {
            radius: self.radius,
            ..robot.strut_with(self.force(), self.coil.rate())
        }
    }

    /// What a pair or a radial spring comes to.
    fn ideal(&self) -> Spring {
        let (rate, radius) = (self.coil.rate(), self.radius);
        // N mm per radian.
        let per_radian = match self.geometry {
            // Anchors in line with the pivot, one `installed` further out: turned by z,
            // the pull has a lever of both radii over their distance, times sin z.
            Geometry::Radial => {
                let outer = radius + self.installed;
                self.force() * radius * outer / self.installed
            }
            // One gets longer by what the other gets shorter.
            _ => 2.0 * rate * radius * radius,
        };
        Spring {
            rate: per_radian.to_radians(),
            preload: 0.0,
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
        let spring = hung(Geometry::Radial).ideal();
        let degree = 1f64.to_radians();
        let torque = torque(COIL, 20.0, 50.0, degree);
        assert!(
            (torque / spring.rate - 1.0).abs() < 0.01,
            "{torque} {spring:?}"
        );
        assert_eq!(spring.preload, 0.0);
    }

    #[test]
    fn a_pair_has_the_rate_of_both_springs() {
        let pair = hung(Geometry::Pair).ideal();
        assert!((pair.rate - (2.0 * COIL.rate() * 400.0).to_radians()).abs() < 1e-12);
        assert_eq!(pair.preload, 0.0);
    }

    #[test]
    fn in_a_strut_it_is_the_robots_own() {
        let text = include_str!("../../../robots/paper.toml");
        let own = format!("{text}\n[leg.drive]\nkind = \"strut\"\nplay = 0.5\n");
        let robot = Robot::parse(&own).expect("right");
        let hung = Hung {
            coil: robot.parts().spring,
            geometry: Geometry::Strut,
            radius: robot.parts().anchor[0],
            installed: robot.hung(),
        };
        assert_eq!(hung.drive(&robot), *robot.drive());
    }
}
