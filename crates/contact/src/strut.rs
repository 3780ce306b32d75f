//! A slotted strut with a tension spring, which connects a servo's arm to its leg's arm.
//!
//! The two arms are equal and parallel. With the strut and the line from the servo's shaft to the leg's pivot they form
//! a parallelogram. The leg's screw runs in a slot of the strut, and a spring pulls the screw against one end of the
//! slot. So the strut can grow longer but not shorter: the leg can lag behind its servo in one direction only, which is
//! forward at the front legs and back at the hind legs of the paper's robot. The torque of the spring on the leg is its
//! pull times a lever arm: the component of the arm perpendicular to the strut, which changes with the pose.

use lizard_kinematics::wrap;

use crate::lag_energy::{Resistance, StrutTriangle};
use crate::legs::FORWARD_TURN_SIGN;

/// Distance that the leg's screw can slide in the slot of its strut, mm.
pub const SLOT_LENGTH: f64 = 5.0;

/// A slotted strut and its spring; all four struts are identical.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strut {
    /// Pull of the spring while the leg does not lag, N.
    pub force: f64,
    /// Rate of the spring, N/mm.
    pub rate: f64,
    /// Distance that the screw can slide in the slot, mm.
    pub slot_length: f64,
    /// Distance between the strut's screws while the leg does not lag, mm.
    pub length: f64,
    /// Length of the servo's arm, and of the leg's arm, mm.
    pub arm_length: f64,
    /// Angles from the strut's direction to the servo's arm at neutral, deg.
    pub arm_angles: [f64; 4],
}

impl Strut {
    /// The triangle of the strut while the servo is at this sweep (deg, foot forward positive).
    fn triangle(&self, leg: usize, sweep: f64) -> StrutTriangle {
        let arm_deg = self.arm_angles[leg] + FORWARD_TURN_SIGN[leg] * sweep;
        let (sin, cos) = arm_deg.to_radians().sin_cos();
        // Vector from the leg's pivot to the servo's end of the strut.
        let servo_end = [self.arm_length * cos - self.length, self.arm_length * sin];
        let enclosed_deg = wrap(arm_deg - servo_end[1].atan2(servo_end[0]).to_degrees());
        // A positive lag turns the leg's arm backward.
        let angle = -FORWARD_TURN_SIGN[leg] * enclosed_deg.to_radians();
        StrutTriangle::new(servo_end[0].hypot(servo_end[1]), self.arm_length, angle)
    }

    /// Lever arm of the strut's pull about the leg's pivot, mm, while the leg does not lag and the servo is at this
    /// sweep, deg.
    pub fn lever_arm(&self, leg: usize, sweep: f64) -> f64 {
        self.triangle(leg, sweep).lever_arm().abs()
    }

    /// Lag (deg) at which the screw reaches the far end of the slot, and the spring's torque at that lag (N mm),
    /// with the servo at this sweep, deg.
    pub fn slot_end(&self, leg: usize, sweep: f64) -> (f64, f64) {
        let triangle = self.triangle(leg, sweep);
        let lag = triangle.lag_at_growth(self.slot_length);
        let force = self.force + self.rate * self.slot_length;
        let torque = force * triangle.lever_arm_after(lag);
        (lag.to_degrees(), torque)
    }

    /// The resistances to a negative and to a positive lag, with `force_unit` N as the unit of force and the servo
    /// at this sweep, deg.
    pub(crate) fn resistances(&self, leg: usize, sweep: f64, force_unit: f64) -> [Resistance; 2] {
        let triangle = self.triangle(leg, sweep);
        let strut_resistance = Resistance::strut(
            triangle,
            self.force / force_unit,
            self.rate / force_unit,
            self.slot_length,
        );
        match triangle.lever_arm() > 0.0 {
            true => [Resistance::Stop, strut_resistance],
            false => [strut_resistance, Resistance::Stop],
        }
    }
}
