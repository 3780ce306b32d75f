//! A strut with a slot and a tension spring in it, from a servo's link to its leg.
//!
//! Shaft, leg's pivot and two equal, parallel arms make a parallelogram whose fourth side
//! is the strut. The leg's screw runs in a slot of the strut, and a spring pulls the
//! screw against the slot's end. So the strut can grow longer but not shorter: the leg
//! can lag behind its servo in one direction only, which is forward at the front legs and
//! back at the hind legs of the paper's robot. The torque of the spring on the leg is its
//! pull times a lever. The lever is the arm's component square to the strut, and it
//! changes with the pose.

use lizard_kinematics::wrap;

use crate::lag_energy::{Side, Stretch};
use crate::legs::FORWARD;

/// Distance that the leg's screw can slide in the slot of its strut, mm.
pub const SLOT: f64 = 5.0;

/// A slotted strut and its spring; all four struts are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strut {
    /// Pull of the spring while the leg does not lag, N.
    pub force: f64,
    /// Rate of the spring, N/mm.
    pub rate: f64,
    /// Distance that the screw can slide in the slot, mm.
    pub slot: f64,
    /// Distance from screw to screw while the leg does not lag, mm.
    pub length: f64,
    /// Length of the servo's arm and of the leg's arm, mm.
    pub radius: f64,
    /// Angle from the strut's direction to the servo's arm at neutral, deg, for each leg in
    /// servo order.
    pub angles: [f64; 4],
}

impl Strut {
    /// The geometry of stretching the strut while the servo is at this sweep (deg, foot forward
    /// positive).
    fn stretch(&self, leg: usize, sweep: f64) -> Stretch {
        let arm_deg = self.angles[leg] + FORWARD[leg] * sweep;
        let (sin, cos) = arm_deg.to_radians().sin_cos();
        // From the leg's pivot to the servo's end of the strut.
        let servo_end = [self.radius * cos - self.length, self.radius * sin];
        let enclosed_deg = wrap(arm_deg - servo_end[1].atan2(servo_end[0]).to_degrees());
        // A lag turns the leg's arm against the forward direction.
        let angle = -FORWARD[leg] * enclosed_deg.to_radians();
        Stretch::new(servo_end[0].hypot(servo_end[1]), self.radius, angle)
    }

    /// Lever of the strut's pull at the leg's pivot, mm, while the leg does not lag.
    pub fn lever(&self, leg: usize, sweep: f64) -> f64 {
        self.stretch(leg, sweep).lever().abs()
    }

    /// Lag with the screw at the end of the slot, deg, and the torque at that lag, N mm.
    pub fn slot_end(&self, leg: usize, sweep: f64) -> (f64, f64) {
        let stretch = self.stretch(leg, sweep);
        let lag = stretch.lag_at_growth(self.slot);
        let force = self.force + self.rate * self.slot;
        let torque = force * stretch.lever_after(lag);
        (lag.to_degrees(), torque)
    }

    /// The resistance to a lag against the sweep's direction and along it, in units of `force_unit` N.
    pub(crate) fn sides(&self, leg: usize, sweep: f64, force_unit: f64) -> [Side; 2] {
        let stretch = self.stretch(leg, sweep);
        let side = Side::strut(
            stretch,
            self.force / force_unit,
            self.rate / force_unit,
            self.slot,
        );
        match stretch.lever() > 0.0 {
            true => [Side::Stop, side],
            false => [side, Side::Stop],
        }
    }
}
