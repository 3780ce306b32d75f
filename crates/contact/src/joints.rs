//! Dry friction of pins and sliders, which a servo has to overcome besides the friction of its pad.
//!
//! The pins of a servo's leg and crank turn with it, so their friction is one torque at the servo.
//! A slider joins the arms of two servos: it resists the change of its length, with a lever that
//! depends on both angles. It hardly moves while all legs move together; when one leg swings
//! alone, its servo must move the slider, too.

use crate::legs::FORWARD;

/// The friction of the mechanism between the servos and their legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joints {
    /// Torque of the dry friction in the pins that a servo turns, N mm.
    pub drag: f64,
    /// Force of the dry friction in a slider, N.
    pub slider: f64,
    /// Arms of the sliders from the servos' shafts at neutral: forward, left, mm; servo order.
    pub arms: [[f64; 2]; 4],
    /// Distance from the hind shafts to the front ones, mm.
    pub base: f64,
}

/// The servos of each side's slider: front and hind.
const SIDES: [[usize; 2]; 2] = [[0, 3], [1, 2]];

impl Joints {
    /// Derivatives of the sliders' lengths by each servo's sweep, mm/rad, at sweeps in deg.
    pub(crate) fn levers(&self, sweeps: [f64; 4]) -> [f64; 4] {
        let mut levers = [0.0; 4];
        let arms: [[f64; 2]; 4] = std::array::from_fn(|i| {
            let (sin, cos) = (FORWARD[i] * sweeps[i]).to_radians().sin_cos();
            let [x, y] = self.arms[i];
            [x * cos - y * sin, x * sin + y * cos]
        });
        for [front, hind] in SIDES {
            let slider = [
                self.base + arms[front][0] - arms[hind][0],
                arms[front][1] - arms[hind][1],
            ];
            let length = slider[0].hypot(slider[1]);
            for (servo, sign) in [(front, 1.0), (hind, -1.0)] {
                let [x, y] = arms[servo];
                levers[servo] = sign * FORWARD[servo] * (x * slider[1] - y * slider[0]) / length;
            }
        }
        levers
    }

    /// Torques of the sliders on the servos, N mm, at sweeps in deg and rates in rad/s. Below a slider
    /// speed of `fade_speed` mm/s the friction is proportional to the speed, so that it never turns a servo back.
    pub(crate) fn torques(&self, sweeps: [f64; 4], rates: [f64; 4], fade_speed: f64) -> [f64; 4] {
        if self.slider == 0.0 {
            return [0.0; 4];
        }
        let levers = self.levers(sweeps);
        let mut torques = [0.0; 4];
        for side in SIDES {
            let speed: f64 = side.map(|i| levers[i] * rates[i]).iter().sum();
            let force = -self.slider * (speed / fade_speed).clamp(-1.0, 1.0);
            for i in side {
                torques[i] = force * levers[i];
            }
        }
        torques
    }
}
