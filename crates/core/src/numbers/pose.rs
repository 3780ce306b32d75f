//! A pose of the robot: the sweeps of the four servos from their neutral angles.
//!
//! The horns are fitted while the servos hold their neutral pulse width. Therefore a sweep is the angle by which a
//! servo really turns, and a chassis angle can be measured on the robot. All arrays have the order of [`Servo`].

use crate::numbers::calibration::Calibration;
use crate::numbers::part::Servo;
use crate::numbers::units::{Angle, PulseWidth, Sweep};

/// Four sweeps, in servo order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Pose(pub [Sweep; 4]);

/// Four pulse widths, in servo order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Pulses(pub [PulseWidth; 4]);

impl Pose {
    /// The pose in which all servos are at their neutral angles and the robot stands.
    pub const NEUTRAL: Self = Self([Sweep(0); 4]);

    /// Computes the pose with these chassis angles from the servos' neutral angles; the pose may exceed the travel.
    pub fn from_angles(angles: &[Angle; 4], neutral_angles: &[Angle; 4]) -> Self {
        let mut pose = Self::NEUTRAL;
        for (sweep, (angle, neutral)) in pose.0.iter_mut().zip(angles.iter().zip(neutral_angles)) {
            *sweep = neutral.sweep_to(*angle);
        }
        pose
    }

    /// Computes the chassis angles of the servos from their neutral angles.
    pub fn angles(&self, neutral_angles: &[Angle; 4]) -> [Angle; 4] {
        let mut angles = *neutral_angles;
        for (angle, sweep) in angles.iter_mut().zip(&self.0) {
            *angle = angle.offset_by(*sweep);
        }
        angles
    }

    /// Returns the first servo whose sweep exceeds its travel; `None` if every sweep is within its travel.
    pub fn first_servo_beyond_travel(&self, calibration: &[Calibration; 4]) -> Option<Servo> {
        for (index, servo) in calibration.iter().enumerate() {
            if !servo.reaches(self.0[index]) {
                return Some(Servo::at(index));
            }
        }
        None
    }

    /// Computes the pulses that hold this pose.
    pub fn pulses(&self, calibration: &[Calibration; 4]) -> Pulses {
        let mut pulses = Pulses::default();
        for (index, servo) in calibration.iter().enumerate() {
            pulses.0[index] = servo.width(self.0[index]);
        }
        pulses
    }

    /// Computes the largest turn of any servo between this pose and `other`, 1/65536 turn.
    pub fn max_turn_to(&self, other: &Self) -> u16 {
        let mut max_turn = 0;
        for (from, to) in self.0.iter().zip(&other.0) {
            max_turn = max_turn.max(from.0.abs_diff(to.0));
        }
        max_turn
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sample::Sample;

    proptest! {
        #[test]
        fn a_pose_within_the_travel_is_recovered_from_its_angles((robot, pose) in Sample::random_with_pose()) {
            let angles = pose.angles(&robot.neutral_angles());
            prop_assert_eq!(Pose::from_angles(&angles, &robot.neutral_angles()), pose);
            prop_assert_eq!(pose.first_servo_beyond_travel(&robot.calibration()), None);
        }

        #[test]
        fn the_first_servo_beyond_its_travel_is_returned(
            (robot, mut pose) in Sample::random_with_pose(),
            are_beyond: [bool; 4],
        ) {
            for (index, is_beyond) in are_beyond.into_iter().enumerate() {
                if is_beyond {
                    pose.0[index] = Sweep(robot.calibration()[index].travel_max.0 + 1);
                }
            }
            let first_servo = are_beyond.iter().position(|is_beyond| *is_beyond).map(Servo::at);
            prop_assert_eq!(pose.first_servo_beyond_travel(&robot.calibration()), first_servo);
        }

        #[test]
        fn every_servo_gets_the_pulse_of_its_own_calibration((robot, pose) in Sample::random_with_pose()) {
            let pulses = pose.pulses(&robot.calibration());
            for index in 0..4 {
                let width = robot.calibration()[index].width(pose.0[index]);
                prop_assert_eq!(pulses.0[index], width);
            }
        }

        #[test]
        fn the_largest_turn_includes_all_servos_and_is_equal_in_both_directions(
            from: [i16; 4],
            to: [i16; 4],
        ) {
            let turns = (0..4).map(|index| from[index].abs_diff(to[index]));
            let [from, to] = [from, to].map(|sweeps| Pose(sweeps.map(Sweep)));
            prop_assert_eq!(Some(from.max_turn_to(&to)), turns.max());
            prop_assert_eq!(from.max_turn_to(&to), to.max_turn_to(&from));
        }
    }
}
