//! The robot as the core reads it.
//!
//! The build script writes it into the firmware as constants; on a host it is a
//! [`lizard_core::robot::Robot`] itself, so that guard, gaits and motion of any
//! robot.toml can be run and proved without building a firmware.

use std::sync::Arc;

use lizard_avr::Flash;
use lizard_core::adjustment::Reach;
use lizard_core::calibration::Calibration;
use lizard_core::five_bar::FiveBar;
use lizard_core::gait::{Gait, Wave};
use lizard_core::limits::Limits;
use lizard_core::part::{End, Servo, Side};
use lizard_core::point_to_point::Slew;
use lizard_core::robot::Robot;
use lizard_core::slider::Slider;
use lizard_core::supply::Supplies;
use lizard_core::units::{Angle, Scale};

use crate::generate;
use crate::numbers::Numbers;
use crate::table::Tables;

/// A robot in the integers of the core.
#[derive(Debug, Clone, PartialEq)]
pub struct CoreRobot {
    numbers: Numbers,
    hash: u32,
    servo_hash: u32,
}

impl CoreRobot {
    /// The robot of these numbers.
    pub(crate) fn new(numbers: Numbers) -> Self {
        Self {
            hash: generate::hash(&numbers),
            servo_hash: generate::servo_hash(&numbers),
            numbers,
        }
    }

    /// Arduino numbers of the servos' pins, A1 to A4; 14 to 19 are A0 to A5.
    pub fn pins(&self) -> [u8; 4] {
        self.numbers.pins
    }

    /// Arduino number of the pin where the servos' rail is measured, 14 to 19.
    pub fn rail_pin(&self) -> Option<u8> {
        self.numbers.rail_pin
    }

    /// The step of the lengths of an end's five-bar.
    pub fn end_scale(&self, end: End) -> Scale {
        self.numbers.ends[end as usize].scale
    }

    /// CRC-32 of all the numbers, as the firmware's banner shows it.
    pub fn hash(&self) -> u32 {
        self.hash
    }

    /// The Rust source that the firmware includes.
    pub fn source(&self) -> String {
        generate::source(&self.numbers)
    }

    /// The gaits' tables.
    pub(crate) fn tables(&self) -> &Arc<Tables> {
        &self.numbers.tables
    }
}

impl Robot for CoreRobot {
    fn end(&self, end: End) -> FiveBar<'_> {
        self.numbers.ends[end as usize].five_bar()
    }

    fn side(&self, side: Side) -> Slider {
        self.numbers.sides[side as usize]
    }

    fn limits(&self) -> Limits {
        self.numbers.limits
    }

    fn slew(&self) -> Slew {
        self.numbers.slew
    }

    fn neutral(&self) -> [Angle; 4] {
        self.numbers.neutral
    }

    fn calibration(&self) -> [Calibration; 4] {
        self.numbers.calibration
    }

    fn gaits(&self) -> Flash<'_, [Gait]> {
        Flash::from(self.numbers.tables.gaits.as_slice())
    }

    fn names(&self) -> Flash<'_, [u8]> {
        Flash::from(self.numbers.tables.names.as_slice())
    }

    fn waves(&self) -> Flash<'_, [Wave]> {
        Flash::from(self.numbers.tables.waves.as_slice())
    }

    fn reach(&self, servo: Servo) -> Reach {
        *servo.of(&self.numbers.reach)
    }

    fn supplies(&self) -> Supplies {
        self.numbers.supplies
    }

    fn hash(&self) -> u32 {
        self.hash
    }

    fn servo_hash(&self) -> u32 {
        self.servo_hash
    }
}
