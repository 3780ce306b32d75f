//! What a leg feels of the spring in its strut: from which torque on it lags behind its
//! servo, and what a servo must bear when a foot is caught.

use std::fmt;

use serde::Serialize;

use crate::bodies::assembly::Assembly;
use crate::decimals;

/// What an SG-90 turns at a stall with 4.8 V, N mm: 1.8 kg cm.
pub const STALL: f64 = 176.0;

/// A leg's spring in its strut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Hold {
    /// Length inside its hooks in the strut, mm.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub installed: f64,
    /// Its pull there, N.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub force: f64,
    /// N/mm.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub rate: f64,
    /// Lever of the strut about the leg's pivot, mm: the least and the greatest that any
    /// leg has in any gait. The pull acts square to the anchor's arm at one pose only.
    #[serde(serialize_with = "decimals::each::<1000, _>")]
    pub lever: [f64; 2],
    /// Up to this torque the leg follows its servo exactly wherever gaits lead, N mm.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub preload: f64,
    /// How far a leg lags at the slot's end, deg: the least and the most that gaits' poses
    /// have.
    #[serde(serialize_with = "decimals::each::<1000, _>")]
    pub way: [f64; 2],
    /// What holds the leg there, N mm, likewise.
    #[serde(serialize_with = "decimals::each::<1000, _>")]
    pub end: [f64; 2],
    /// What dry friction of its pad asks of a leg, N mm.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub friction: f64,
}

impl Hold {
    /// Whether a servo can go on turning at the slot's end: with less than seven tenths of
    /// the torque at which it stalls.
    #[must_use]
    pub fn spares(&self) -> bool {
        self.end[1] < 0.7 * STALL
    }

    /// Of the robot's legs, whose struts are equal. `None` where these are rigid.
    #[must_use]
    pub fn of(assembly: &Assembly) -> Option<Self> {
        let robot = assembly.robot();
        let strut = robot.drive().strut()?;
        const NONE: [f64; 2] = [f64::INFINITY, 0.0];
        let (mut lever, mut way, mut end) = (NONE, NONE, NONE);
        let widen = |range: &mut [f64; 2], value: f64| {
            *range = [range[0].min(value), range[1].max(value)];
        };
        for gait in robot.gaits() {
            for (_, phase) in gait.frames() {
                let sweeps = robot.sweeps(gait.table_angles(phase));
                for (leg, sweep) in sweeps.into_iter().enumerate() {
                    let (lag, torque) = strut.end(leg, sweep);
                    widen(&mut lever, strut.lever(leg, sweep));
                    widen(&mut way, lag);
                    widen(&mut end, torque);
                }
            }
        }
        let ground = robot.ground();
        Some(Self {
            installed: robot.hung(),
            force: strut.force,
            rate: strut.rate,
            lever,
            preload: strut.force * lever[0],
            way,
            end,
            friction: ground.grip() * ground.feet.reach,
        })
    }
}

impl fmt::Display for Hold {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            installed,
            force,
            rate,
            lever,
            preload,
            way,
            end,
            friction,
        } = self;
        writeln!(
            f,
            "Each spring is {installed:.1} mm long in its strut and pulls {force:.1} N ({rate:.2} N/mm), at a lever of \
             {:.1} to {:.1} mm in gaits. So a leg follows its servo up to {preload:.0} N mm, and the pad's friction asks for \
             about {friction:.0}: what the spring does is to take up the play of its strut's two screws. With foot and body \
             both held, a front foot on its way forward or a hind foot on its way back, the slot ends after {:.0} to {:.0} \
             deg, at {:.0} to {:.0} N mm; the other way the strut is a bar. An SG-90 stalls at {STALL:.0} N mm. {}",
            lever[0],
            lever[1],
            way[0],
            way[1],
            end[0],
            end[1],
            match self.spares() {
                true => "So much less spares it.",
                false =>
                    "So a caught foot can stall its servo as with a rigid strut: switch the servos' supply off.",
            }
        )?;
        if preload < friction {
            writeln!(
                f,
                "That is less than the friction: the legs will lag. Take a stronger spring."
            )?;
        }
        Ok(())
    }
}
