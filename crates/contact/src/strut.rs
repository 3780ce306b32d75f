//! A slotted strut with a tension spring, which connects a servo's arm to its leg's arm.
//!
//! The two arms are equal and parallel. With the strut and the line from the servo's shaft to the leg's pivot they form
//! a parallelogram. The leg's screw runs in a slot of the strut, and a spring pulls the screw against one end of the
//! slot. The strut can therefore lengthen but not shorten, and the leg can lag behind its servo in one direction only:
//! in the paper's robot, forward at the front legs and back at the hind legs. The spring's torque on the leg is the
//! spring's tension times a lever arm, which changes with the pose: the arm's component perpendicular to the strut.

use lizard_kinematics::wrap;

use crate::lag_energy::{Resistance, StrutTriangle};
use crate::legs::FORWARD_TURN_SIGN;

/// Distance that the leg's screw can slide in the slot of its strut, mm.
pub const SLOT_LENGTH: f64 = 5.0;

/// A slotted strut and its spring; all four struts are identical.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strut {
    /// Tension of the spring while the leg does not lag, N.
    pub preload: f64,
    /// Rate of the spring, N/mm.
    pub spring_rate: f64,
    /// Distance that the screw can slide in the slot, mm.
    pub slot_length: f64,
    /// Distance between the strut's screws while the leg does not lag, mm.
    pub screw_distance: f64,
    /// Length of the servo's arm, which equals the leg's arm, mm.
    pub arm_length: f64,
    /// Angles from the strut's direction to each servo's arm at neutral, deg.
    pub arm_angles: [f64; 4],
}

impl Strut {
    /// Computes the strut's triangle with the servo at `sweep` (deg, foot forward positive).
    fn compute_triangle(&self, leg: usize, sweep: f64) -> StrutTriangle {
        let arm_deg = self.arm_angles[leg] + FORWARD_TURN_SIGN[leg] * sweep;
        let (sin, cos) = arm_deg.to_radians().sin_cos();
        // Vector from the leg's pivot to the servo's end of the strut.
        let x = self.arm_length * cos - self.screw_distance;
        let y = self.arm_length * sin;
        let enclosed_deg = wrap(arm_deg - y.atan2(x).to_degrees());
        // A positive lag turns the leg's arm backward.
        let angle = -FORWARD_TURN_SIGN[leg] * enclosed_deg.to_radians();
        StrutTriangle::new(x.hypot(y), self.arm_length, angle)
    }

    /// Lever arm of the strut's pull about the leg's pivot without a lag, mm, with the servo at `sweep` (deg).
    pub fn lever_arm(&self, leg: usize, sweep: f64) -> f64 {
        self.compute_triangle(leg, sweep).lever_arm().abs()
    }

    /// Computes the lag (deg) at which the screw reaches the far end of the slot, and the spring's torque at that lag
    /// (N mm), with the servo at `sweep` (deg).
    pub fn lag_and_torque_at_slot_end(&self, leg: usize, sweep: f64) -> (f64, f64) {
        let triangle = self.compute_triangle(leg, sweep);
        let lag = triangle.lag_at_extension(self.slot_length);
        let tension = self.preload + self.spring_rate * self.slot_length;
        let (_, lever_arm, _) = triangle.extension_and_derivatives(lag);
        (lag.to_degrees(), tension * lever_arm)
    }

    /// Computes the resistances to a negative and a positive lag, in units of `force_unit` newtons, with the servo at
    /// `sweep` (deg).
    pub(crate) fn resistances(&self, leg: usize, sweep: f64, force_unit: f64) -> [Resistance; 2] {
        let triangle = self.compute_triangle(leg, sweep);
        let [preload, rate] = [self.preload, self.spring_rate].map(|value| value / force_unit);
        let strut_resistance = Resistance::strut(triangle, preload, rate, self.slot_length);
        match triangle.lever_arm() > 0.0 {
            true => [Resistance::Stop, strut_resistance],
            false => [strut_resistance, Resistance::Stop],
        }
    }
}
