//! A pose of the robot: where the four servos stand, as sweeps from neutral.
//!
//! The horns are fitted while the servos hold their neutral pulse, so that a
//! sweep is what the servo really turns and a chassis angle is what a person
//! can read off the robot. Order everywhere: A1 = theta1 front left,
//! A2 = theta4 front right, A3 = theta8 back right, A4 = theta5 back left.

use crate::calibration::Calibration;
use crate::part::Servo;
use crate::units::{Angle, Sweep, Width};

/// Four sweeps, in servo order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pose(pub [Sweep; 4]);

/// Four pulse widths, in servo order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pulses(pub [Width; 4]);

impl Pose {
    /// All servos at their neutral angle: the robot stands.
    pub const NEUTRAL: Self = Self([Sweep(0); 4]);

    /// The pose at four chassis angles.
    ///
    /// # Errors
    /// The first servo whose travel does not reach its angle.
    pub fn at(
        angles: &[Angle; 4],
        neutral: &[Angle; 4],
        calibration: &[Calibration; 4],
    ) -> Result<Self, Servo> {
        let mut pose = Self::NEUTRAL;
        for place in 0..4 {
            let sweep = neutral[place].sweep_to(angles[place]);
            if !calibration[place].reaches(sweep) {
                return Err(Servo::at(place));
            }
            pose.0[place] = sweep;
        }
        Ok(pose)
    }

    /// The chassis angles of the servos.
    pub fn angles(&self, neutral: &[Angle; 4]) -> [Angle; 4] {
        let mut angles = *neutral;
        for (angle, sweep) in angles.iter_mut().zip(&self.0) {
            *angle = angle.swept(*sweep);
        }
        angles
    }

    /// The pulses that hold this pose.
    pub fn pulses(&self, calibration: &[Calibration; 4]) -> Pulses {
        let mut pulses = Pulses::default();
        for (index, servo) in calibration.iter().enumerate() {
            pulses.0[index] = servo.width(self.0[index]);
        }
        pulses
    }

    /// The longest way of any servo to `other`, in 1/65536 turn.
    pub fn farthest(&self, other: &Self) -> u16 {
        let mut most = 0;
        for (here, there) in self.0.iter().zip(&other.0) {
            most = most.max(here.0.abs_diff(there.0));
        }
        most
    }
}
