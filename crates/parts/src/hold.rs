//! The effect of the springs in the legs' struts: the torque above which a leg lags behind its servo, and the torque
//! on the servo when a foot is caught.

use std::fmt;

use serde::Serialize;

use crate::bodies::assembly::Assembly;
use crate::decimals;

/// The effect of the springs in the legs' struts, over all gaits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpringEffect {
    /// Length of the spring mounted in the strut, mm, measured inside its hooks.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub installed: f64,
    /// Pull of the mounted spring, N.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub force: f64,
    /// Rate of the spring, N/mm.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub rate: f64,
    /// Lever arm of the strut's pull about the leg's pivot, mm: the least and the greatest of any leg in any gait. It
    /// varies, since the pull is perpendicular to the anchor's arm at one pose only.
    #[serde(rename = "lever", serialize_with = "decimals::each::<1000, _>")]
    pub lever_arm_range: [f64; 2],
    /// Torque up to which the leg follows its servo exactly in all gaits, N mm.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub preload: f64,
    /// Lag of a leg at the slot's end, deg: the least and the greatest of all gaits.
    #[serde(rename = "way", serialize_with = "decimals::each::<1000, _>")]
    pub lag_range: [f64; 2],
    /// Torque on the leg at the slot's end, N mm: the least and the greatest of all gaits.
    #[serde(rename = "end", serialize_with = "decimals::each::<1000, _>")]
    pub torque_range: [f64; 2],
    /// Torque that the friction of its pad exerts on a leg, N mm.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub friction: f64,
    /// Torque at which the leg's servo stalls, N mm.
    #[serde(serialize_with = "decimals::one::<1000, _>")]
    pub stall: f64,
}

impl SpringEffect {
    /// True if a servo can continue to turn when its leg has reached the end of the slot: the greatest torque there
    /// is less than 0.7 of the servo's stall torque.
    pub fn lets_servo_turn(&self) -> bool {
        self.torque_range[1] < 0.7 * self.stall
    }

    /// The effect in a robot, whose struts are all equal; `None` if they are rigid.
    pub fn of(assembly: &Assembly) -> Option<Self> {
        let robot = assembly.robot();
        let strut = robot.drive().strut()?;
        // The least and the greatest lever arm, lag and torque.
        let mut ranges = [[f64::INFINITY, 0.0]; 3];
        for gait in robot.gaits() {
            for (_, phase) in gait.frames() {
                let sweeps = robot.sweeps(gait.table_angles(phase));
                for (leg, sweep) in sweeps.into_iter().enumerate() {
                    let (lag, torque) = strut.slot_end(leg, sweep);
                    let values = [strut.lever_arm(leg, sweep), lag, torque];
                    for (range, value) in ranges.iter_mut().zip(values) {
                        *range = [range[0].min(value), range[1].max(value)];
                    }
                }
            }
        }
        let [lever_arm_range, lag_range, torque_range] = ranges;
        let ground = robot.ground();
        Some(Self {
            installed: robot.mounted_spring_length(),
            force: strut.force,
            rate: strut.rate,
            lever_arm_range,
            preload: strut.force * lever_arm_range[0],
            lag_range,
            torque_range,
            friction: ground.mean_pad_friction() * ground.feet.reach,
            stall: robot.motors().per_servo[0].stall_torque,
        })
    }
}

impl fmt::Display for SpringEffect {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (installed, force, rate) = (self.installed, self.force, self.rate);
        let (preload, friction, stall) = (self.preload, self.friction, self.stall);
        let (
            [least_lever, greatest_lever],
            [least_lag, greatest_lag],
            [least_torque, greatest_torque],
        ) = (self.lever_arm_range, self.lag_range, self.torque_range);
        let stall_text = match self.lets_servo_turn() {
            true => "So a caught foot does not stall it.",
            false => {
                "So a caught foot can stall its servo as with a rigid strut: switch the servos' supply off."
            }
        };
        writeln!(
            f,
            "Each spring is {installed:.1} mm long in its strut and pulls {force:.1} N ({rate:.2} N/mm), at a lever of \
             {least_lever:.1} to {greatest_lever:.1} mm in gaits. So a leg follows its servo up to {preload:.0} N mm, and the pad's friction \
             takes about {friction:.0}: the use of the spring is to take up the play of its strut's two screws. If foot \
             and body are both held while a front leg turns forward or a hind leg back, the slot ends after \
             {least_lag:.0} to {greatest_lag:.0} deg, at {least_torque:.0} to {greatest_torque:.0} N mm; in the other direction the strut is rigid. A servo stalls \
             at {stall:.0} N mm. {stall_text}"
        )?;
        match preload < friction {
            true => writeln!(
                f,
                "The springs are weaker than the friction, so the legs will lag. Take stronger springs."
            ),
            false => Ok(()),
        }
    }
}
