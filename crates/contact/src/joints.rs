//! Dry friction of pins and sliders, which a servo has to overcome in addition to its pad's friction on the floor.
//!
//! The pins of a servo's leg and crank turn with the servo, so their friction is a single torque at its shaft. A slider
//! joins the arms of two servos and resists changes of its length; its lever arm at each servo depends on both
//! servos' angles. While all legs move together, its length hardly changes; a leg that swings alone must change it.

use crate::legs::FORWARD_TURN_SIGN;

/// The dry friction of the mechanism between the servos and their legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointFriction {
    /// Friction of the pins that a servo turns, as a torque at its shaft, N mm.
    pub pin_torque: f64,
    /// Friction of a slider, N.
    pub slider_force: f64,
    /// Vectors from each servo's shaft to the tip of its slider arm at neutral: (forward, left), mm.
    pub slider_arms: [[f64; 2]; 4],
    /// Vectors from the hind to the front servo's shaft, on the left and on the right side: (forward, left), mm.
    pub shaft_spans: [[f64; 2]; 2],
}

/// The front and the hind servo of each slider: the left slider first, then the right one.
const SLIDER_SERVOS: [[usize; 2]; 2] = [[0, 3], [1, 2]];

impl JointFriction {
    /// Computes the sliders' lever arms at the servos: the derivatives of the sliders' lengths with respect to each
    /// servo's sweep, mm/rad. `sweeps` are in deg.
    pub(crate) fn slider_lever_arms(&self, sweeps: [f64; 4]) -> [f64; 4] {
        let mut lever_arms = [0.0; 4];
        let arms: [[f64; 2]; 4] = std::array::from_fn(|servo| {
            let turn_deg = FORWARD_TURN_SIGN[servo] * sweeps[servo];
            let (sin, cos) = turn_deg.to_radians().sin_cos();
            let [x, y] = self.slider_arms[servo];
            [x * cos - y * sin, x * sin + y * cos]
        });
        for ([front, hind], [forward, left]) in SLIDER_SERVOS.into_iter().zip(self.shaft_spans) {
            let span = [
                forward + arms[front][0] - arms[hind][0],
                left + arms[front][1] - arms[hind][1],
            ];
            let length = span[0].hypot(span[1]);
            for (servo, sign) in [(front, 1.0), (hind, -1.0)] {
                let [x, y] = arms[servo];
                lever_arms[servo] =
                    sign * FORWARD_TURN_SIGN[servo] * (x * span[1] - y * span[0]) / length;
            }
        }
        lever_arms
    }

    /// Computes the sliders' friction torques on the servos, N mm. `sweeps` are in deg, `rates_rad_s` in rad/s. At
    /// slider speeds below `smoothing_speed` (mm/s) friction is proportional to speed, so it never reverses a servo.
    pub(crate) fn slider_torques(
        &self,
        sweeps: [f64; 4],
        rates_rad_s: [f64; 4],
        smoothing_speed: f64,
    ) -> [f64; 4] {
        if self.slider_force == 0.0 {
            return [0.0; 4];
        }
        let lever_arms = self.slider_lever_arms(sweeps);
        let mut torques = [0.0; 4];
        for servo_pair in SLIDER_SERVOS {
            let speeds = servo_pair.map(|servo| lever_arms[servo] * rates_rad_s[servo]);
            let speed: f64 = speeds.iter().sum();
            let force = -self.slider_force * (speed / smoothing_speed).clamp(-1.0, 1.0);
            for servo in servo_pair {
                torques[servo] = force * lever_arms[servo];
            }
        }
        torques
    }
}
