//! Models of a hobby servo: a motor with limited torque and rate that turns towards the angle of its pulse, and stops
//! inside the dead band.

use lizard_robot::{Motors, Robot};

use crate::FRAME_PERIOD_S;

/// A model of the robot's servos.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "a program copies only a few models"
)]
pub enum ServoModel {
    /// Servos that follow their pulses at once and exactly.
    Ideal,
    /// Servos whose rate limit and dead band do not depend on the load; much faster to simulate than
    /// [`ServoModel::Motors`].
    Unloaded {
        /// Largest rate of turn.
        max_rate_deg_per_s: f64,
        /// Width of the dead band: a servo ignores an error of up to half this width.
        dead_band_us: f64,
    },
    /// Servos with motors of limited torque and rate and with inertia, loaded by the pads' friction.
    Motors(Motors),
}

impl ServoModel {
    /// An unloaded SG-90: 60 degrees in 0.12 s, dead band 10 us (data sheet).
    pub const SG90: Self = Self::Unloaded {
        max_rate_deg_per_s: 500.0,
        dead_band_us: 10.0,
    };

    /// Creates the model of a robot's servos at the voltage of their supply.
    pub fn for_robot(robot: &Robot) -> Self {
        Self::Motors(robot.motors())
    }

    /// Computes the sweep that a servo without load has at the end of a frame, from its sweep `start` at the beginning
    /// and the sweep `target` of its pulse, all in deg; `us_per_degree` is the servo's gain.
    pub fn compute_end_sweep(&self, start: f64, target: f64, us_per_degree: f64) -> f64 {
        let Self::Unloaded {
            max_rate_deg_per_s,
            dead_band_us,
        } = self
        else {
            return target;
        };
        let half_band = dead_band_us / 2.0 / us_per_degree.abs();
        let max_step = max_rate_deg_per_s * FRAME_PERIOD_S;
        let end = start.clamp(target - half_band, target + half_band);
        start + (end - start).clamp(-max_step, max_step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_servo_turns_no_faster_than_its_largest_rate() {
        let servo = ServoModel::Unloaded {
            max_rate_deg_per_s: 500.0,
            dead_band_us: 0.0,
        };
        assert_eq!(servo.compute_end_sweep(0.0, 6.0, 10.0), 6.0);
        assert_eq!(servo.compute_end_sweep(0.0, 60.0, 10.0), 10.0);
        assert_eq!(servo.compute_end_sweep(0.0, -60.0, -10.0), -10.0);
    }

    #[test]
    fn a_servo_does_not_turn_inside_its_dead_band() {
        let sg90 = ServoModel::SG90;
        let compute_end_sweep = |start, target| sg90.compute_end_sweep(start, target, -10.0);
        assert_eq!(compute_end_sweep(3.0, 3.5), 3.0);
        assert_eq!(
            compute_end_sweep(3.0, 4.0),
            3.5,
            "the edge of the dead band"
        );
        assert_eq!(compute_end_sweep(3.5, 3.0), 3.5);
        assert_eq!(compute_end_sweep(3.5, 2.0), 2.5);
    }
}
