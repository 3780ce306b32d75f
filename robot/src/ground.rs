//! Feet that are never lifted: where the robot goes when its legs swing.
//!
//! Planar, quasi-static, Coulomb friction. At each instant the pads slide so
//! that the power lost to friction is least: of all twists (vx, vy, omega) of
//! the body, the one that minimises `sum |v + omega x r_i + dr_i/dt|` over the
//! feet. Three feet that agree out-vote one that returns, and the body advances.
//! Speed, weight and a common friction coefficient cancel.

/// Where the feet are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feet {
    /// Hips ahead of and behind the chassis centre, mm.
    pub hip_forward: f64,
    /// Hips to either side, mm.
    pub hip_side: f64,
    /// Outward sweep of the legs at neutral, deg: front legs forward, hind legs
    /// back.
    pub mount: f64,
    /// Length of a leg's crank: from the hip to the foot, mm.
    pub reach: f64,
}

/// The contact model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    feet: Feet,
    /// Friction of a pad that slides backward over that of one that slides
    /// forward.
    ratio: f64,
}

impl Ground {
    /// Feet on a floor, with the pads' friction backward over forward.
    pub fn new(feet: Feet, ratio: f64) -> Self {
        Self { feet, ratio }
    }
}
