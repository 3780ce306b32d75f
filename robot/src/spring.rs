//! The spring between a servo's crank and its leg.
//!
//! The servo turns a crank, the leg follows it through a spring, and the pad's
//! friction holds the leg back. What matters to the foot is one number: the torque
//! that the spring exerts on the leg when the leg lags behind its crank. Three
//! built geometries have this form. A spring that pulls along the arc of its
//! anchors has a rate and no preload. One that pulls radially holds the leg by its
//! tension, and its tension makes the rate. A strut with a stop follows without
//! any lag up to its preload and then yields at its rate.

/// A leg's spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// Torque for each degree that the leg lags, beyond the preload, N mm/deg.
    pub rate: f64,
    /// Torque up to which the leg does not lag at all, N mm; 0 without a stop.
    pub preload: f64,
}

impl Spring {
    /// Its lag at a torque, deg.
    #[must_use]
    pub fn lag(&self, torque: f64) -> f64 {
        (torque.abs() - self.preload).max(0.0).copysign(torque) / self.rate
    }

    /// Its torque in other units: 1 is `force` N at a lever of 1 mm, and angles
    /// are radians.
    pub(crate) fn over(&self, force: f64) -> Yield {
        Yield {
            rate: self.rate.to_degrees() / force,
            preload: self.preload / force,
        }
    }
}

/// A spring in the units of the contact problem: forces over the mean friction of
/// a pad, mm and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Yield {
    /// Per radian of lag.
    pub rate: f64,
    /// At the smallest lag.
    pub preload: f64,
}

impl Yield {
    /// The energy at a lag (rad), its slope and its curvature. The kink of the
    /// preload is rounded off within `eps` rad.
    pub fn expand(&self, lag: f64, eps: f64) -> (f64, f64, f64) {
        let length = lag.hypot(eps);
        (
            self.preload * length + 0.5 * self.rate * lag * lag,
            self.preload * lag / length + self.rate * lag,
            self.preload * (eps / length) * (eps / length) / length + self.rate,
        )
    }

    /// The most that a torque can gain on this spring: the convex conjugate of the
    /// energy, which the proof by duality needs.
    #[cfg(test)]
    pub fn conjugate(&self, torque: f64) -> f64 {
        let beyond = (torque.abs() - self.preload).max(0.0);
        beyond * beyond / (2.0 * self.rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leg_lags_by_what_the_torque_has_beyond_the_preload() {
        let plain = Spring {
            rate: 5.0,
            preload: 0.0,
        };
        assert_eq!((plain.lag(20.0), plain.lag(-20.0)), (4.0, -4.0));
        let stop = Spring {
            preload: 15.0,
            ..plain
        };
        assert_eq!(
            (stop.lag(15.0), stop.lag(20.0), stop.lag(-25.0)),
            (0.0, 1.0, -2.0)
        );
    }

    #[test]
    fn the_slope_of_the_energy_is_the_torque() {
        let spring = Spring {
            rate: 5.0,
            preload: 15.0,
        }
        .over(0.5);
        // 15 N mm and 4 deg of 5 N mm, over 0.5 N.
        let (_, torque, _) = spring.expand(4f64.to_radians(), 0.0);
        assert!((torque - 35.0 / 0.5).abs() < 1e-9, "{torque}");
        // And by differences of the energy.
        let (lag, step, eps) = (0.02, 1e-6, 1e-3);
        let at = |lag| spring.expand(lag, eps);
        let slope = (at(lag + step).0 - at(lag - step).0) / (2.0 * step);
        let curvature = (at(lag + step).1 - at(lag - step).1) / (2.0 * step);
        assert!((at(lag).1 - slope).abs() < 1e-6 * slope);
        assert!((at(lag).2 - curvature).abs() < 1e-6 * curvature);
    }
}
