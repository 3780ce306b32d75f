//! The contact of a robot with its floor.
//!
//! The model is planar and quasi-static, with Coulomb friction. At each instant the pads slide so that friction
//! dissipates as little power as possible: the body moves with the velocity (vx, vy, omega) that minimises
//! `sum mu N_i |v + omega x r_i + dr_i/dt|` over the feet, where `mu` is the friction coefficient, `N_i` a foot's load
//! and `r_i` its position. Three feet that move together prevail over one that swings, and the body advances. If the
//! legs are rigid and the servos ideal, the speed, the weight and a friction coefficient common to all feet have no
//! effect. If springs drive the legs, each step minimises the sum of the friction's work and the springs' energy, and
//! the ratio of friction to stiffness decides the lag of a leg behind its servo.

use crate::drive::Drive;
use crate::leg_geometry::{Body, LegGeometry};
use crate::stance::Stance;

/// The contact of a robot with a floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundContact {
    /// Positions of the hips, and length and mounting of the legs.
    pub legs: LegGeometry,
    /// Mass and centre of mass.
    pub body: Body,
    /// Stiffness and lengths of the feet, which decide their loads.
    pub stance: Stance,
    /// Friction coefficient of a pad that slides forward. It has an effect only if springs drive the legs or the
    /// servos are not ideal.
    pub friction_coefficient: f64,
    /// Ratio of a pad's friction coefficients: backward slide over forward slide.
    pub friction_ratio: f64,
    /// Drive of each leg by its servo.
    pub drive: Drive,
}

/// The paper's robot on feet of equal length, with rigid struts.
#[cfg(test)]
pub(crate) const PAPER_GROUND: GroundContact = GroundContact {
    legs: crate::leg_geometry::PAPER_LEGS,
    body: Body::DEFAULT,
    stance: Stance::LEVEL,
    friction_coefficient: DEFAULT_FRICTION,
    friction_ratio: 1.0,
    drive: Drive::RIGID,
};

/// Default friction coefficient: rubber on a smooth floor.
pub const DEFAULT_FRICTION: f64 = 0.7;

impl GroundContact {
    /// Returns this contact with rigid struts without play: no leg lags, so no step depends on earlier steps.
    pub fn with_rigid_drive(&self) -> Self {
        Self {
            drive: Drive::RIGID,
            ..*self
        }
    }

    /// Friction force of a pad under the mean load, N, which a leg's spring or motor has to overcome.
    pub fn mean_friction_force(&self) -> f64 {
        self.friction_coefficient * self.body.mean_load()
    }
}
