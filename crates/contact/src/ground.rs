//! The robot and its floor in the contact model.
//!
//! Planar, quasi-static, Coulomb friction. At each instant the pads slide so that the power
//! lost to friction is minimal: the body moves with the twist (vx, vy, omega) that minimises
//! `sum mu N |v + omega x r_i + dr_i/dt|` over the feet. Three feet in stance, which move
//! together, win against one in swing, and the body advances. Speed, weight and a common
//! friction coefficient cancel, as long as the legs are rigid. If springs drive the legs, each
//! step minimises the friction's work and the springs' energy together, and the ratio of
//! friction to stiffness decides the lag of a leg behind its servo.

use crate::drive::Drive;
use crate::feet::{Body, Feet};
use crate::stance::Stance;

/// A robot on a floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Geometry of the feet.
    pub feet: Feet,
    /// Mass and mass centre.
    pub body: Body,
    /// Stiffness and lengths of the feet, which decide their loads.
    pub stance: Stance,
    /// Friction coefficient of a pad that slides forward. It has an effect only together with
    /// springs or motors.
    pub friction: f64,
    /// Friction coefficient of a pad that slides backward, divided by that of one that slides
    /// forward.
    pub ratio: f64,
    /// Drive of each leg from its servo's link.
    pub drive: Drive,
}

/// The default friction coefficient: rubber on a smooth floor.
pub const DEFAULT_FRICTION: f64 = 0.7;

impl Ground {
    /// Returns this robot and floor with legs that do not lag, so that no step depends on
    /// earlier ones.
    pub fn rigid(&self) -> Self {
        Self {
            drive: Drive::RIGID,
            ..*self
        }
    }

    /// Loads of feet at these positions (forward, left in mm, servo order), as shares of the mean.
    pub fn loads(&self, feet: [[f64; 2]; 4]) -> [f64; 4] {
        self.stance.loads(&self.body, feet)
    }

    /// Friction of a foot with the mean load, N: the force that a leg's spring or motor has to overcome.
    pub fn grip(&self) -> f64 {
        self.friction * self.body.mean_load()
    }
}
