//! The spring between a servo's crank and its leg.
//!
//! The servo turns a crank, the leg follows it through a spring, and the pad's friction
//! holds the leg back. Only one function matters to the foot: the torque that the spring
//! exerts on the leg when the leg lags behind its crank. This module has the ideal
//! spring, equal in both directions and at every pose. Two springs that pull against each
//! other along the arc of their anchors come close to it, with a rate and no preload; so
//! does a spring that pulls radially and holds the leg by its tension. A spring in a
//! slotted strut does not: see `strut.rs`.

use crate::yields::Side;

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

    /// Its torque to one side in other units: 1 is `force` N at a lever of 1 mm, and angles
    /// are radians.
    pub(crate) fn side(&self, force: f64) -> Side {
        Side::Spring {
            rate: self.rate.to_degrees() / force,
            preload: self.preload / force,
        }
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
}
