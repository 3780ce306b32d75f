//! The drive of a leg by its servo, through a strut: `[leg.drive]` in robot.toml.
//!
//! A rigid strut is a bar with two holes: the leg moves exactly with its servo. A strut with a slot and a spring
//! moves the leg exactly with its servo until the load exceeds the spring's tension; then the strut yields in one
//! direction. With either strut, pins and gears have play, within which nothing drives the leg.

use crate::lag_energy::{LagEnergy, Resistance};
use crate::strut::Strut;

/// The drive of each leg; all four are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Connection between servo and leg.
    pub kind: DriveKind,
    /// Free movement of a leg to either side, deg.
    pub play: f64,
}

/// The connection between a servo's link and its leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DriveKind {
    /// A rigid strut: the leg follows its servo exactly, except for the play.
    Rigid,
    /// A strut with a slot and a tension spring, which yields in one direction.
    Strut(Strut),
}

impl Drive {
    /// A leg that follows its servo exactly.
    pub const RIGID: Self = Self {
        kind: DriveKind::Rigid,
        play: 0.0,
    };

    /// True if a leg can lag behind its servo.
    pub fn can_lag(&self) -> bool {
        self.kind != DriveKind::Rigid || self.play > 0.0
    }

    /// The slotted strut; `None` if the strut is rigid.
    pub fn strut(&self) -> Option<&Strut> {
        match &self.kind {
            DriveKind::Strut(strut) => Some(strut),
            DriveKind::Rigid => None,
        }
    }

    /// Name of the kind in robot.toml.
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            DriveKind::Rigid => "rigid",
            DriveKind::Strut(_) => "strut",
        }
    }

    /// Clamps a lag (deg) to the leg's stops with its servo at `sweep` (deg).
    pub(crate) fn clamp_lag(&self, leg: usize, sweep: f64, lag: f64) -> f64 {
        let [min, max] = self.lag_energy(leg, sweep, 1.0, 1.0).lag_range();
        lag.clamp(min.to_degrees(), max.to_degrees())
    }

    /// Returns the energy of a leg's lag with its servo at `sweep` (deg). The unit of force is `force_unit` newtons;
    /// `max_pad_torque` is an upper bound of a pad's torque on its leg, in that unit times mm.
    pub(crate) fn lag_energy(
        &self,
        leg: usize,
        sweep: f64,
        force_unit: f64,
        max_pad_torque: f64,
    ) -> LagEnergy {
        LagEnergy {
            play: self.play.to_radians(),
            stop_torque: 1.25 * max_pad_torque,
            resistances: match &self.kind {
                DriveKind::Rigid => [Resistance::Stop; 2],
                DriveKind::Strut(strut) => strut.resistances(leg, sweep, force_unit),
            },
            motor: None,
        }
    }
}
