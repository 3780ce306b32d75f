//! A hobby servo: a motor that turns towards the angle of its pulse at a limited rate,
//! and stops when the error is inside its dead band.

use crate::FRAME;

/// What a servo can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoModel {
    /// Fastest turn, deg/s.
    pub rate: f64,
    /// Width of the dead band, us: half of it to either side of the pulse is as good
    /// as none.
    pub dead_band: f64,
}

impl ServoModel {
    /// An SG-90: 60 degrees in 0.12 s without load, 10 us (data sheet).
    pub const SG90: Self = Self {
        rate: 500.0,
        dead_band: 10.0,
    };

    /// A servo that is where its pulse says, at once.
    pub const IDEAL: Self = Self {
        rate: f64::INFINITY,
        dead_band: 0.0,
    };

    /// The sweep (deg) a frame after it was `from` when its pulse asks for `target`;
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
    fn inside_its_dead_band_it_stays() {
        let turned = |from, target| ServoModel::SG90.turned(from, target, -10.0);
        assert_eq!(turned(3.0, 3.5), 3.0);
        assert_eq!(turned(3.0, 4.0), 3.5, "it stops at the edge");
        assert_eq!(turned(3.5, 3.0), 3.5);
        assert_eq!(turned(3.5, 2.0), 2.5);
    }

    #[test]
    fn an_ideal_one_is_where_its_pulse_says() {
        assert_eq!(ServoModel::IDEAL.turned(-80.0, 80.0, 10.0), 80.0);
    }
}
