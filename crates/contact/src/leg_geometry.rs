//! The geometry of the legs, and the body that stands on them.

use crate::friction::Point;
use crate::legs::{FRONT_SIGN, LEFT_SIGN};

/// Standard gravity, m/s^2.
pub const GRAVITY: f64 = 9.80665;

/// The positions of the hips, and the length and the mounting of the legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegGeometry {
    /// Distance from the chassis centre forward to the front hips and back to the hind hips, mm.
    pub hip_forward: f64,
    /// Distances from the chassis's long axis to the front hips and to the hind hips, mm.
    pub hip_side: [f64; 2],
    /// Outward sweep of the legs with the servos at neutral, deg: front legs forward, hind legs back.
    pub mount_angle: f64,
    /// Length of a leg's crank, mm: the distance from the hip to the foot.
    pub reach: f64,
}

impl LegGeometry {
    /// Positions of the hips in servo order: (forward, left) from the chassis centre, mm.
    pub fn hips(&self) -> [Point; 4] {
        std::array::from_fn(|i| {
            let [front, hind] = self.hip_side;
            let side = if FRONT_SIGN[i] > 0.0 { front } else { hind };
            [FRONT_SIGN[i] * self.hip_forward, LEFT_SIGN[i] * side]
        })
    }

    /// Positions of the feet at these sweeps (deg, servo order): (forward, left) from the chassis centre, mm.
    pub fn foot_positions(&self, sweeps: [f64; 4]) -> [Point; 4] {
        let hips = self.hips();
        std::array::from_fn(|i| {
            let (sin, cos) = self.leg_sin_cos(i, sweeps[i]);
            [
                hips[i][0] + self.reach * sin,
                hips[i][1] + LEFT_SIGN[i] * self.reach * cos,
            ]
        })
    }

    /// Derivatives of the feet's positions with respect to their legs' sweeps, mm/rad.
    pub(crate) fn sweep_derivatives(&self, sweeps: [f64; 4]) -> [Point; 4] {
        std::array::from_fn(|i| {
            let (sin, cos) = self.leg_sin_cos(i, sweeps[i]);
            [self.reach * cos, -LEFT_SIGN[i] * self.reach * sin]
        })
    }

    /// Sine and cosine of a leg's angle, measured from straight sideways, forward positive.
    fn leg_sin_cos(&self, leg: usize, sweep: f64) -> (f64, f64) {
        let angle_deg = sweep + FRONT_SIGN[leg] * self.mount_angle;
        angle_deg.to_radians().sin_cos()
    }
}

/// The robot's mass and centre of mass, which the feet carry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass of the whole robot, g.
    pub mass: f64,
    /// Centre of mass: (forward, left) from the chassis centre, mm.
    pub centre_of_mass: Point,
}

/// Fraction of a robot's mass that moves with one pad. In the paper's robot it is 15 g of 435 g: the foot, its
/// coupler, and crank and follower in proportion to the displacement of their centres.
const LEG_MASS_FRACTION: f64 = 15.0 / 435.0;

impl Body {
    /// The default of robot.toml: the mass of the paper's parts, centred.
    pub const DEFAULT: Self = Self {
        mass: 435.0,
        centre_of_mass: [0.0; 2],
    };

    /// The mass that moves with a pad, g.
    pub fn leg_mass(&self) -> f64 {
        LEG_MASS_FRACTION * self.mass
    }

    /// Mean load of a foot, N.
    pub fn mean_load(&self) -> f64 {
        self.mass / 1000.0 * GRAVITY / 4.0
    }
}

/// The legs of the paper's robot.
#[cfg(test)]
pub(crate) const PAPER_LEGS: LegGeometry = LegGeometry {
    hip_forward: 55.0,
    hip_side: [35.0; 2],
    mount_angle: 0.0,
    reach: 45.0,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assert_near;

    #[test]
    fn each_foot_is_one_crank_length_from_its_hip_in_the_direction_of_its_leg() {
        let legs = PAPER_LEGS;
        let expected_positions = [[55.0, 80.0], [55.0, -80.0], [-55.0, -80.0], [-55.0, 80.0]];
        assert_eq!(legs.foot_positions([0.0; 4]), expected_positions);
        let forward_feet = legs.foot_positions([90.0; 4]);
        let expected_positions = [[100.0, 35.0], [100.0, -35.0], [-10.0, -35.0], [-10.0, 35.0]];
        for (foot, expected_point) in forward_feet.into_iter().zip(expected_positions) {
            let error = (foot[0] - expected_point[0]).hypot(foot[1] - expected_point[1]);
            assert!(error < 1e-12, "expected {expected_point:?}, got {foot:?}");
        }
        let splayed_legs = LegGeometry {
            mount_angle: 90.0,
            ..legs
        };
        let positions = splayed_legs.foot_positions([0.0; 4]);
        assert_near(positions[0][0], 100.0, 1e-12);
        assert_near(positions[2][0], -100.0, 1e-9);
    }

    #[test]
    fn sweep_derivatives_match_difference_quotients_of_the_positions() {
        let legs = LegGeometry {
            mount_angle: 12.0,
            ..PAPER_LEGS
        };
        let sweeps = [10.0, -5.0, 20.0, -15.0];
        let step_deg = 1e-5;
        let [positions, stepped_positions] =
            [0.0, step_deg].map(|step| legs.foot_positions(sweeps.map(|sweep| sweep + step)));
        for (i, derivative) in legs.sweep_derivatives(sweeps).into_iter().enumerate() {
            for axis in 0..2 {
                let difference_quotient =
                    (stepped_positions[i][axis] - positions[i][axis]) / step_deg.to_radians();
                assert_near(derivative[axis], difference_quotient, 1e-3);
            }
        }
    }
}
