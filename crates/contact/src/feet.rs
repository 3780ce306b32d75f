//! The geometry of the feet, and the body that stands on them.

use crate::friction::Point;
use crate::legs::{FRONT, LEFT};

/// Standard gravity, m/s^2.
pub const GRAVITY: f64 = 9.80665;

/// The geometry of the feet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feet {
    /// Distance of the front hips ahead of the chassis centre, mm; the hind hips are as far behind it.
    pub hip_forward: f64,
    /// Distances of the front and of the hind hips from the chassis's long axis, to either side, mm.
    pub hip_side: [f64; 2],
    /// Outward sweep of the legs at neutral, deg: front legs forward, hind legs
    /// back.
    pub mount: f64,
    /// Length of a leg's crank, from the hip to the foot, mm.
    pub reach: f64,
}

impl Feet {
    /// The hips in servo order: (forward, left) from the chassis centre, mm.
    pub fn hips(&self) -> [Point; 4] {
        std::array::from_fn(|i| {
            let [front, hind] = self.hip_side;
            let side = if FRONT[i] > 0.0 { front } else { hind };
            [FRONT[i] * self.hip_forward, LEFT[i] * side]
        })
    }

    /// Positions of the feet at these sweeps (deg, servo order): (forward, left) from the
    /// chassis centre, mm.
    pub fn positions(&self, sweeps: [f64; 4]) -> [Point; 4] {
        let hips = self.hips();
        std::array::from_fn(|i| {
            let (sin, cos) = self.direction_sin_cos(i, sweeps[i]);
            [
                hips[i][0] + self.reach * sin,
                hips[i][1] + LEFT[i] * self.reach * cos,
            ]
        })
    }

    /// Derivative of each foot's position by its leg's sweep, mm/rad.
    pub(crate) fn sweep_derivatives(&self, sweeps: [f64; 4]) -> [Point; 4] {
        std::array::from_fn(|i| {
            let (sin, cos) = self.direction_sin_cos(i, sweeps[i]);
            [self.reach * cos, -LEFT[i] * self.reach * sin]
        })
    }

    fn direction_sin_cos(&self, leg: usize, sweep: f64) -> (f64, f64) {
        (sweep + FRONT[leg] * self.mount).to_radians().sin_cos()
    }
}

/// The robot's mass and centre of mass, which the feet carry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass of the whole robot, g.
    pub mass: f64,
    /// Centre of mass: (forward, left) from the chassis centre, mm.
    pub centre: Point,
}

/// Share of a robot's mass that moves with one pad. Of the paper robot's 435 g this is 15 g: the foot, its coupler,
/// and the share of crank and follower that corresponds to the movement of their centres.
const LEG_SHARE: f64 = 15.0 / 435.0;

impl Body {
    /// The default of robot.toml: the weight of the paper's parts.
    pub const DEFAULT: Self = Self {
        mass: 435.0,
        centre: [0.0; 2],
    };

    /// The mass that moves with a pad, g.
    pub fn leg_mass(&self) -> f64 {
        LEG_SHARE * self.mass
    }

    /// Mean load of a foot, N.
    pub fn mean_load(&self) -> f64 {
        self.mass / 1000.0 * GRAVITY / 4.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feet_stand_where_the_parallelograms_put_them() {
        let feet = Feet {
            hip_forward: 55.0,
            hip_side: [35.0; 2],
            mount: 0.0,
            reach: 45.0,
        };
        assert_eq!(
            feet.positions([0.0; 4]),
            [[55.0, 80.0], [55.0, -80.0], [-55.0, -80.0], [-55.0, 80.0]]
        );
        let forward_feet = feet.positions([90.0; 4]);
        let expected = [[100.0, 35.0], [100.0, -35.0], [-10.0, -35.0], [-10.0, 35.0]];
        for (foot, point) in forward_feet.into_iter().zip(expected) {
            assert!(
                (foot[0] - point[0]).hypot(foot[1] - point[1]) < 1e-12,
                "{foot:?}"
            );
        }
        let splayed_feet = Feet {
            mount: 90.0,
            ..feet
        }
        .positions([0.0; 4]);
        assert!(
            (splayed_feet[0][0] - 100.0).abs() < 1e-12 && (splayed_feet[2][0] + 100.0).abs() < 1e-9
        );
    }

    #[test]
    fn a_foot_moves_along_its_circle() {
        let feet = Feet {
            hip_forward: 55.0,
            hip_side: [35.0; 2],
            mount: 12.0,
            reach: 45.0,
        };
        let sweeps = [10.0, -5.0, 20.0, -15.0];
        let step_deg = 1e-5;
        let (positions, stepped_positions) = (
            feet.positions(sweeps),
            feet.positions(sweeps.map(|s| s + step_deg)),
        );
        for (i, derivative) in feet.sweep_derivatives(sweeps).into_iter().enumerate() {
            for axis in 0..2 {
                let slope =
                    (stepped_positions[i][axis] - positions[i][axis]) / step_deg.to_radians();
                assert!((derivative[axis] - slope).abs() < 1e-3, "{derivative:?}");
            }
        }
    }
}
