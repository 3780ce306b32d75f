//! What the core has to know of a robot.
//!
//! Everything in this crate is generic over a [`Robot`]. The firmware's is a type
//! without size whose numbers are constants: the compiler folds them into the code,
//! and tables stay in flash. A host's is made at run time from a robot.toml, so
//! that the same code can be proved for a robot that no firmware was built for yet.

use lizard_avr::Flash;

use crate::adjustment::Reach;
use crate::calibration::Calibration;
use crate::five_bar::FiveBar;
use crate::gait::{Gait, GaitId, Name, Wave};
use crate::limits::Limits;
use crate::part::{End, Servo, Side};
use crate::point_to_point::Slew;
use crate::slider::Slider;
use crate::supply::Supplies;
use crate::units::Angle;

/// A four-servo lizard: its geometry, limits and gaits. Whoever makes one has
/// checked that its numbers fit and that every gait keeps the limits.
pub trait Robot {
    /// The five-bar of an end, in that end's own frame.
    fn end(&self, end: End) -> FiveBar<'_>;

    /// The five-bar with a slider of a side, as it is in the chassis frame.
    fn side(&self, side: Side) -> Slider;

    /// The smallest margins allowed.
    fn limits(&self) -> Limits;

    /// How fast servos may turn in a point-to-point move.
    fn slew(&self) -> Slew;

    /// The servos' angles in the neutral pose.
    fn neutral(&self) -> [Angle; 4];

    /// One servo of [`Robot::neutral`].
    fn neutral_of(&self, servo: Servo) -> Angle {
        *servo.of(&self.neutral())
    }

    /// The servos' pulses and travel, as robot.toml has them.
    fn calibration(&self) -> [Calibration; 4];

    /// The gaits; the first is `stand`, which holds the neutral pose.
    fn gaits(&self) -> Flash<'_, [Gait]>;

    /// The gaits' names, one after the other.
    fn names(&self) -> Flash<'_, [u8]>;

    /// The waveforms that gaits share.
    fn waves(&self) -> Flash<'_, [Wave]>;

    /// One servo of [`Robot::calibration`].
    fn servo(&self, servo: Servo) -> Calibration {
        *servo.of(&self.calibration())
    }

    /// The sweeps that the gaits and the neutral pose need of a servo.
    fn reach(&self, servo: Servo) -> Reach;

    /// The supplies that are measured, and what their voltages mean.
    fn supplies(&self) -> Supplies;

    /// A number by which two sets of numbers are told apart.
    fn hash(&self) -> u32;

    /// The same of the servos alone: their pins, pulses and neutral angles.
    fn servo_hash(&self) -> u32;

    /// A gait, fetched from flash.
    fn gait(&self, id: GaitId) -> Gait {
        let gait = self.gaits().get(id.index());
        gait.map_or(Gait::STILL, Flash::load)
    }

    /// A gait's name.
    fn name(&self, id: GaitId) -> Name<'_> {
        Name::of(&self.gait(id), self.names())
    }
}

impl<R: Robot + ?Sized> Robot for &R {
    fn end(&self, end: End) -> FiveBar<'_> {
        (**self).end(end)
    }

    fn side(&self, side: Side) -> Slider {
        (**self).side(side)
    }

    fn limits(&self) -> Limits {
        (**self).limits()
    }

    fn slew(&self) -> Slew {
        (**self).slew()
    }

    fn neutral(&self) -> [Angle; 4] {
        (**self).neutral()
    }

    fn neutral_of(&self, servo: Servo) -> Angle {
        (**self).neutral_of(servo)
    }

    fn calibration(&self) -> [Calibration; 4] {
        (**self).calibration()
    }

    fn gaits(&self) -> Flash<'_, [Gait]> {
        (**self).gaits()
    }

    fn names(&self) -> Flash<'_, [u8]> {
        (**self).names()
    }

    fn waves(&self) -> Flash<'_, [Wave]> {
        (**self).waves()
    }

    fn servo(&self, servo: Servo) -> Calibration {
        (**self).servo(servo)
    }

    fn reach(&self, servo: Servo) -> Reach {
        (**self).reach(servo)
    }

    fn supplies(&self) -> Supplies {
        (**self).supplies()
    }

    fn hash(&self) -> u32 {
        (**self).hash()
    }

    fn servo_hash(&self) -> u32 {
        (**self).servo_hash()
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::sample::{GAITS, Sample};

    /// What a robot's gaits are called, by the trait alone.
    fn names<R: Robot>(robot: R) -> Vec<Vec<u8>> {
        GaitId::all(robot.gaits().len())
            .map(|id| robot.name(id).collect())
            .collect()
    }

    #[test]
    fn a_reference_to_a_robot_is_that_robot() {
        let robot = Sample::odd();
        let reference = &robot;
        assert_eq!(names(reference), GAITS.map(|name| name.as_bytes().to_vec()));
        for (place, side) in Side::ALL.into_iter().enumerate() {
            assert_eq!((&reference).side(side), robot.sides[place]);
        }
        assert_eq!((&reference).limits(), robot.limits);
        assert_eq!((&reference).slew(), robot.slew);
        assert_eq!((&reference).neutral(), robot.neutral);
        assert_eq!((&reference).calibration(), robot.calibration);
        for servo in Servo::ALL {
            assert_eq!((&reference).reach(servo), *servo.of(&robot.reach));
            assert_eq!((&reference).servo(servo), *servo.of(&robot.calibration));
            assert_eq!((&reference).neutral_of(servo), *servo.of(&robot.neutral));
        }
        assert_eq!((&reference).supplies(), robot.supplies);
        assert_eq!((&reference).hash(), robot.hash);
        assert_eq!((&reference).servo_hash(), robot.servo_hash);
    }

    #[test]
    fn a_gait_is_fetched_by_its_place() {
        let robot = Sample::odd();
        for (id, gait) in GaitId::all(robot.gaits().len()).zip(&robot.gaits) {
            assert_eq!(robot.gait(id), *gait);
        }
    }
}
