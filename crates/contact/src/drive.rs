//! The drive of a leg from its servo's link: `[leg.drive]` in robot.toml.
//!
//! Parts, bill, contact model, twin and page all use this table. With a rigid strut, a bar with two holes, the
//! leg moves exactly with its servo. With a strut that has a slot and a spring, the leg moves exactly with its servo
//! while the load is below the spring's pull; under a larger load the strut yields in one direction. With either
//! strut, pins and gears have play, within which nothing drives the leg.

use crate::lag_energy::{LagEnergy, Side};
use crate::strut::Strut;

/// The drive of the legs; all four are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Kind of the connection.
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

impl DriveKind {
    /// Names of the kinds in robot.toml.
    pub const WORDS: [&str; 2] = ["rigid", "strut"];
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

    /// The slotted strut; `None` for another kind.
    pub fn strut(&self) -> Option<&Strut> {
        match &self.kind {
            DriveKind::Strut(strut) => Some(strut),
            DriveKind::Rigid => None,
        }
    }

    /// Name of the kind in robot.toml.
    pub fn word(&self) -> &'static str {
        match self.kind {
            DriveKind::Rigid => DriveKind::WORDS[0],
            DriveKind::Strut(_) => DriveKind::WORDS[1],
        }
    }

    /// Limits a lag (deg) to the range between the stops, with the servo at this sweep, deg.
    pub(crate) fn limit_lag(&self, leg: usize, sweep: f64, lag: f64) -> f64 {
        let stops = self
            .lag_energy_of_leg(leg, sweep, 1.0, 1.0)
            .stops()
            .map(f64::to_degrees);
        lag.clamp(stops[0], stops[1])
    }

    /// The energy of this leg's lag while its servo is at this sweep, deg. Forces are in units of `force_unit` N;
    /// `max_pad_torque` bounds the torque of a pad on its leg, in those units times mm.
    pub(crate) fn lag_energy_of_leg(
        &self,
        leg: usize,
        sweep: f64,
        force_unit: f64,
        max_pad_torque: f64,
    ) -> LagEnergy {
        let [lower, upper] = match &self.kind {
            DriveKind::Rigid => [Side::Stop; 2],
            DriveKind::Strut(strut) => strut.sides(leg, sweep, force_unit),
        };
        LagEnergy {
            play: self.play.to_radians(),
            stop: 1.25 * max_pad_torque,
            lower,
            upper,
            motor: None,
        }
    }
}
