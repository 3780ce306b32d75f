//! A hobby servo: a motor that turns towards the angle of its pulse at a limited rate,
//! and stops when the error is inside its dead band.

use crate::FRAME;

/// The speed and the dead band of a servo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoModel {
    /// Fastest turn, deg/s.
    pub rate: f64,
    /// Width of the dead band, us: a servo ignores an error of up to half of it.
    pub dead_band: f64,
}

impl ServoModel {
    /// An SG-90: 60 degrees in 0.12 s without load, 10 us (data sheet).
    pub const SG90: Self = Self {
        rate: 500.0,
        dead_band: 10.0,
    };

    /// A servo that follows its pulse at once and exactly.
    pub const IDEAL: Self = Self {
        rate: f64::INFINITY,
        dead_band: 0.0,
    };

    /// Computes the sweep (deg) one frame after `from`, with a pulse for `target`;
    /// `us_per_degree` is the servo's gain.
    #[must_use]
    pub fn turned(&self, from: f64, target: f64, us_per_degree: f64) -> f64 {
        let idle = self.dead_band / 2.0 / us_per_degree.abs();
        let most = self.rate * FRAME;
        let stops = from.clamp(target - idle, target + idle);
        from + (stops - from).clamp(-most, most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_turns_no_faster_than_it_can() {
        let servo = ServoModel {
            dead_band: 0.0,
            ..ServoModel::SG90
        };
        assert_eq!(servo.turned(0.0, 6.0, 10.0), 6.0);
        assert_eq!(servo.turned(0.0, 60.0, 10.0), 10.0);
        assert_eq!(servo.turned(0.0, -60.0, -10.0), -10.0);
    }

    #[test]
    fn inside_its_dead_band_it_does_not_turn() {
        let turned = |from, target| ServoModel::SG90.turned(from, target, -10.0);
        assert_eq!(turned(3.0, 3.5), 3.0);
        assert_eq!(turned(3.0, 4.0), 3.5, "it stops at the edge");
        assert_eq!(turned(3.5, 3.0), 3.5);
        assert_eq!(turned(3.5, 2.0), 2.5);
    }

    #[test]
    fn an_ideal_servo_follows_its_pulse_at_once() {
        assert_eq!(ServoModel::IDEAL.turned(-80.0, 80.0, 10.0), 80.0);
    }
}
