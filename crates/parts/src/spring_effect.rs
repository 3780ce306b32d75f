//! The effect of the springs in the legs' struts: the torque above which a leg lags behind its servo, and the torque
//! on the servo when a foot is caught. A leg that lags moves its screw along the strut's slot, up to the slot's end.

use std::fmt;

use serde::Serialize;

use crate::bodies::assembly::Assembly;
use crate::decimals;

/// Effect of the springs in the legs' struts, over all gaits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpringEffect {
    /// Length of the mounted spring inside its hooks, mm.
    #[serde(rename = "installed", serialize_with = "decimals::rounded::<1000, _>")]
    pub installed_length: f64,
    /// Tension of the mounted spring, N.
    #[serde(rename = "force", serialize_with = "decimals::rounded::<1000, _>")]
    pub preload_force: f64,
    /// Rate of the spring, N/mm.
    #[serde(rename = "rate", serialize_with = "decimals::rounded::<1000, _>")]
    pub spring_rate: f64,
    /// Smallest and largest lever arm of the strut's pull about the leg's pivot, over all legs and gaits, mm. The lever
    /// arm varies because the pull is perpendicular to the anchor's arm at only one pose.
    #[serde(rename = "lever", serialize_with = "decimals::rounded_list::<1000, _>")]
    pub lever_arm_range: [f64; 2],
    /// Torque up to which the leg follows its servo exactly in all gaits, N mm.
    #[serde(rename = "preload", serialize_with = "decimals::rounded::<1000, _>")]
    pub preload_torque: f64,
    /// Smallest and largest lag of a leg at the slot's end, over all gaits, deg.
    #[serde(rename = "way", serialize_with = "decimals::rounded_list::<1000, _>")]
    pub lag_range: [f64; 2],
    /// Smallest and largest torque on a leg at the slot's end, over all gaits, N mm.
    #[serde(rename = "end", serialize_with = "decimals::rounded_list::<1000, _>")]
    pub torque_range: [f64; 2],
    /// Torque of a pad's friction on its leg, N mm.
    #[serde(rename = "friction", serialize_with = "decimals::rounded::<1000, _>")]
    pub friction_torque: f64,
    /// Stall torque of the leg's servo, N mm.
    #[serde(rename = "stall", serialize_with = "decimals::rounded::<1000, _>")]
    pub stall_torque: f64,
}

impl SpringEffect {
    /// True if a servo can continue to turn when its leg has reached the slot's end: the largest torque there is less
    /// than 0.7 of the stall torque.
    pub fn lets_servo_turn(&self) -> bool {
        self.torque_range[1] < 0.7 * self.stall_torque
    }

    /// Computes the effect in a robot; `None` if its struts are rigid.
    pub fn compute(assembly: &Assembly) -> Option<Self> {
        let robot = assembly.robot();
        let strut = robot.drive().strut()?;
        // Smallest and largest lever arm, lag and torque.
        let mut ranges = [[f64::INFINITY, 0.0]; 3];
        for gait in robot.gaits() {
            for (_, phase) in gait.frames() {
                let sweeps = robot.sweeps(gait.table_angles(phase));
                for (leg, sweep) in sweeps.into_iter().enumerate() {
                    let (lag, torque) = strut.lag_and_torque_at_slot_end(leg, sweep);
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
            installed_length: robot.mounted_spring_length(),
            preload_force: strut.preload,
            spring_rate: strut.spring_rate,
            lever_arm_range,
            preload_torque: strut.preload * lever_arm_range[0],
            lag_range,
            torque_range,
            friction_torque: ground.mean_friction_force() * ground.legs.reach,
            stall_torque: robot.motors().per_servo[0].stall_torque,
        })
    }
}

impl fmt::Display for SpringEffect {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (length, force, rate) = (self.installed_length, self.preload_force, self.spring_rate);
        let (preload, friction, stall) =
            (self.preload_torque, self.friction_torque, self.stall_torque);
        let [min_lever_arm, max_lever_arm] = self.lever_arm_range;
        let [min_lag, max_lag] = self.lag_range;
        let [min_torque, max_torque] = self.torque_range;
        let stall_text = match self.lets_servo_turn() {
            true => "A caught foot therefore does not stall its servo.",
            false => {
                "A caught foot can therefore stall its servo as with a rigid strut: switch the servos' supply off."
            }
        };
        writeln!(
            f,
            "Each spring is {length:.1} mm long in its strut and pulls {force:.1} N ({rate:.2} N/mm), at a lever arm of \
             {min_lever_arm:.1} to {max_lever_arm:.1} mm in gaits. A leg therefore follows its servo up to {preload:.0} N mm, while its pad's \
             friction is about {friction:.0} N mm: the spring takes up the play of its strut's two screws. If foot and body are both held \
             while a front leg turns forward or a hind leg back, the slot ends after {min_lag:.0} to {max_lag:.0} deg, at \
             {min_torque:.0} to {max_torque:.0} N mm; in the other direction the strut is rigid. A servo stalls at {stall:.0} N mm. \
             {stall_text}"
        )?;
        match preload < friction {
            true => writeln!(
                f,
                "The springs are weaker than the friction, so the legs will lag: use stronger springs."
            ),
            false => Ok(()),
        }
    }
}
