//! Dry friction of pins and sliders, which a servo has to overcome in addition to the friction of its foot's pad on the
//! floor.
//!
//! The pins of a servo's leg and crank turn with the servo, so their friction is a single torque at its shaft. A slider
//! joins the arms of two servos and resists changes of its length; its lever arm at each servo depends on both servos'
//! angles. Its length hardly changes while all legs move together; when one leg swings alone, its servo must change the
//! slider's length, too.

use crate::legs::FORWARD_TURN_SIGN;

/// The dry friction of the mechanism between the servos and their legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointFriction {
    /// Friction of the pins that a servo turns, as a torque at the servo, N mm.
    pub pin_torque: f64,
    /// Friction of a slider, N.
    pub slider_force: f64,
    /// Vectors from each servo's shaft to the tip of its slider arm at neutral: (forward, left), mm.
    pub slider_arms: [[f64; 2]; 4],
    /// Distance from the hind shafts to the front ones, mm.
    pub base: f64,
}

/// The front and the hind servo of each slider: the left slider first, then the right one.
const SLIDER_SERVOS: [[usize; 2]; 2] = [[0, 3], [1, 2]];

impl JointFriction {
    /// Lever arms of the sliders at the servos, at sweeps in deg: derivatives of the sliders' lengths with respect to
    /// each servo's sweep, mm/rad.
    pub(crate) fn slider_lever_arms(&self, sweeps: [f64; 4]) -> [f64; 4] {
        let mut lever_arms = [0.0; 4];
        let arms: [[f64; 2]; 4] = std::array::from_fn(|i| {
            let (sin, cos) = (FORWARD_TURN_SIGN[i] * sweeps[i]).to_radians().sin_cos();
            let [x, y] = self.slider_arms[i];
            [x * cos - y * sin, x * sin + y * cos]
        });
        for [front, hind] in SLIDER_SERVOS {
            let span = [
                self.base + arms[front][0] - arms[hind][0],
                arms[front][1] - arms[hind][1],
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

    /// Torques of the sliders on the servos, N mm, at sweeps in deg and rates in rad/s. At slider speeds below
    /// `fade_speed` (mm/s) the friction is proportional to the speed, so that friction never reverses a servo.
    pub(crate) fn slider_torques(
        &self,
        sweeps: [f64; 4],
        rates: [f64; 4],
        fade_speed: f64,
    ) -> [f64; 4] {
        if self.slider_force == 0.0 {
            return [0.0; 4];
        }
        let lever_arms = self.slider_lever_arms(sweeps);
        let mut torques = [0.0; 4];
        for side in SLIDER_SERVOS {
            let speed: f64 = side.map(|i| lever_arms[i] * rates[i]).iter().sum();
            let force = -self.slider_force * (speed / fade_speed).clamp(-1.0, 1.0);
            for i in side {
                torques[i] = force * lever_arms[i];
            }
        }
        torques
    }
}
