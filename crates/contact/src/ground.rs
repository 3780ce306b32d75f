//! Feet that are never lifted: how the robot moves when its legs swing.
//!
//! Planar, quasi-static, Coulomb friction. At each instant the pads slide so that the
//! power lost to friction is least: the body takes the twist (vx, vy, omega) that
//! minimises `sum mu N |v + omega x r_i + dr_i/dt|` over the feet. Three feet that move
//! together win against one that returns, and the body advances. Speed, weight and a
//! common friction coefficient cancel, as long as the legs are rigid. Where springs pull
//! them, each step minimises the friction's work and the springs' energy together, and
//! friction against stiffness decides how far a leg lags behind its servo.

use crate::drive::Drive;
use crate::feet::{Body, Feet};
use crate::stance::Stance;

/// The contact model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Where the feet are.
    pub feet: Feet,
    /// What they carry.
    pub body: Body,
    /// How they share it.
    pub stance: Stance,
    /// Friction coefficient of a pad that slides forward. It matters only together with a
    /// spring.
    pub friction: f64,
    /// Friction of a pad that slides backward over that of one that slides
    /// forward.
    pub ratio: f64,
    /// What drives each leg from its servo's link.
    pub drive: Drive,
}

/// The friction coefficient that robot.toml means where it says nothing: rubber on
/// a smooth floor.
pub const DEFAULT_FRICTION: f64 = 0.7;

impl Ground {
    /// The same with legs that do not lag: where a step leads then depends on nothing
    /// before it.
    #[must_use]
    pub fn rigid(&self) -> Self {
        Self {
            drive: Drive::RIGID,
            ..*self
        }
    }

    /// What each of the feet (forward, left in mm, servo order) carries over the mean.
    #[must_use]
    pub fn loads(&self, feet: [[f64; 2]; 4]) -> [f64; 4] {
        self.stance.loads(&self.body, feet)
    }

    /// The friction of a foot that carries the mean, N: what a spring works against.
    #[must_use]
    pub fn grip(&self) -> f64 {
        self.friction * self.body.mean_load()
    }
}
