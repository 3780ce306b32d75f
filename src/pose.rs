//! A pose of the robot: where the four servos stand, as sweeps from neutral.
//!
//! The horns are fitted while the servos hold their neutral pulse, so that a
//! sweep is what the servo really turns and a chassis angle is what a person
//! can read off the robot. Order everywhere: A1 = theta1 front left,
//! A2 = theta4 front right, A3 = theta8 back right, A4 = theta5 back left.

use lizard_avr::mul;

use crate::robot::SERVOS;
use crate::units::{angle_from_centideg, centideg_from_angle};

/// One servo: where it is fitted and how its pulse turns it.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    /// Arduino pin number; 14 to 19 are A0 to A5.
    pub pin: u8,
    /// Chassis angle at the neutral pulse, 1/65536 turn.
    pub neutral: u16,
    /// Neutral pulse width in CPU cycles.
    pub neutral_cycles: u16,
    /// CPU cycles for each 1/65536 turn, Q14; negative for a servo whose
    /// longer pulse turns it clockwise.
    pub gain: i16,
    /// The travel's clockwise end, 1/65536 turn from neutral.
    pub min_sweep: i16,
    /// The travel's counter-clockwise end.
    pub max_sweep: i16,
}

impl Servo {
    /// The pulse width, in CPU cycles, that turns the servo to `sweep`.
    pub fn width(&self, sweep: i16) -> u16 {
        let turned = (mul(sweep, self.gain) + (1 << 13)) >> 14;
        self.neutral_cycles.wrapping_add(turned as u16)
    }

    /// True where the travel of the servo reaches `sweep`.
    pub const fn reaches(&self, sweep: i16) -> bool {
        self.min_sweep <= sweep && sweep <= self.max_sweep
    }

    /// The sweep to a chassis angle, the short way round.
    pub const fn sweep_to(&self, angle: u16) -> i16 {
        angle.wrapping_sub(self.neutral) as i16
    }

    /// The chassis angle at `sweep`.
    pub const fn angle_at(&self, sweep: i16) -> u16 {
        self.neutral.wrapping_add(sweep as u16)
    }
}

/// Four sweeps in 1/65536 turn, in servo order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pose(pub [i16; 4]);

/// Four pulse widths in CPU cycles, in servo order; 0 is no pulse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pulses(pub [u16; 4]);

impl Pose {
    /// All servos at their neutral angle: the robot stands.
    pub const NEUTRAL: Self = Self([0; 4]);

    /// The pose at four chassis angles in hundredths of a degree, each less
    /// than two turns; or the first servo whose travel does not reach its angle.
    pub fn at_centideg(angles: &[i32; 4]) -> Result<Self, u8> {
        let mut pose = Self::NEUTRAL;
        for (index, servo) in SERVOS.iter().enumerate() {
            let sweep = servo.sweep_to(angle_from_centideg(angles[index]));
            if !servo.reaches(sweep) {
                return Err(index as u8);
            }
            pose.0[index] = sweep;
        }
        Ok(pose)
    }

    /// The chassis angle of a servo (0..=3), 1/65536 turn.
    pub fn angle(&self, servo: usize) -> u16 {
        SERVOS[servo & 3].angle_at(self.0[servo & 3])
    }

    /// The chassis angle of a servo (0..=3) in hundredths of a degree, 0..36000.
    pub fn centideg(&self, servo: usize) -> u16 {
        centideg_from_angle(self.angle(servo))
    }

    /// The pulses that hold this pose.
    pub fn pulses(&self) -> Pulses {
        let mut pulses = Pulses::default();
        for (index, servo) in SERVOS.iter().enumerate() {
            pulses.0[index] = servo.width(self.0[index]);
        }
        pulses
    }

    /// The longest way of any servo to `other`, in 1/65536 turn.
    pub fn farthest(&self, other: &Self) -> u16 {
        let mut most = 0;
        for (here, there) in self.0.iter().zip(&other.0) {
            most = most.max(here.abs_diff(*there));
        }
        most
    }
}
