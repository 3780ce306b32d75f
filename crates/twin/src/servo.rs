//! A hobby servo: a motor with limited torque and rate that turns towards the angle of its pulse, and stops when the
//! error is inside the dead band.

use lizard_robot::{Motors, Robot};

use crate::FRAME_S;

/// A model of the robot's servos.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "a program has only a few models, and copies them"
)]
pub enum ServoModel {
    /// Servos that follow their pulses at once and exactly.
    Ideal,
    /// Servos with a largest rate and a dead band, both independent of their load. They take a fraction of the
    /// computing time of [`ServoModel::Motors`].
    Unloaded(UnloadedServo),
    /// Servos with motors of limited torque and rate and with inertia, loaded by the pads' friction.
    Motors(Motors),
}

/// The rate and the dead band of a servo without a load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnloadedServo {
    /// Largest rate of turn, deg/s.
    pub rate: f64,
    /// Width of the dead band, us: a servo ignores an error of up to half of it.
    pub dead_band: f64,
}

impl ServoModel {
    /// An SG-90 without a load: 60 degrees in 0.12 s, dead band 10 us (data sheet).
    pub const SG90: Self = Self::Unloaded(UnloadedServo {
        rate: 500.0,
        dead_band: 10.0,
    });

    /// The servos of a robot.toml, at the voltage of their own supply.
    pub fn of(robot: &Robot) -> Self {
        Self::Motors(robot.motors())
    }
}

impl UnloadedServo {
    /// Computes the sweep at the end of a frame that begins at the sweep `start` with a pulse for the sweep `target`,
    /// all in deg; `us_per_degree` is the servo's gain.
    pub fn sweep_after_frame(&self, start: f64, target: f64, us_per_degree: f64) -> f64 {
        let half_band = self.dead_band / 2.0 / us_per_degree.abs();
        let max_step = self.rate * FRAME_S;
        let end = start.clamp(target - half_band, target + half_band);
        start + (end - start).clamp(-max_step, max_step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SG90: UnloadedServo = UnloadedServo {
        rate: 500.0,
        dead_band: 10.0,
    };

    #[test]
    fn a_servo_turns_no_faster_than_its_largest_rate() {
        let servo = UnloadedServo {
            dead_band: 0.0,
            ..SG90
        };
        assert_eq!(servo.sweep_after_frame(0.0, 6.0, 10.0), 6.0);
        assert_eq!(servo.sweep_after_frame(0.0, 60.0, 10.0), 10.0);
        assert_eq!(servo.sweep_after_frame(0.0, -60.0, -10.0), -10.0);
    }

    #[test]
    fn a_servo_does_not_turn_inside_its_dead_band() {
        let sweep_after_frame = |start, target| SG90.sweep_after_frame(start, target, -10.0);
        assert_eq!(sweep_after_frame(3.0, 3.5), 3.0);
        assert_eq!(
            sweep_after_frame(3.0, 4.0),
            3.5,
            "the edge of the dead band"
        );
        assert_eq!(sweep_after_frame(3.5, 3.0), 3.5);
        assert_eq!(sweep_after_frame(3.5, 2.0), 2.5);
    }
}
