//! The robot of this firmware: the numbers that the build script has computed from
//! robot.toml. Constants are folded into the code, tables stay in flash.
//!
//! The build refuses a robot.toml with a length that these types cannot
//! hold or a gait that breaks a margin, so nothing is checked again here.

use lizard_avr::Flash;
use lizard_core::adjustment::Reach;
use lizard_core::calibration::Calibration;
use lizard_core::couplers::{self, Couplers};
use lizard_core::curve::Table;
use lizard_core::five_bar::FiveBar;
use lizard_core::gait::{Channel, Gait, Wave};
use lizard_core::limits::Limits;
use lizard_core::part::{End, Servo, Side};
use lizard_core::point_to_point::Slew;
use lizard_core::robot::Robot;
use lizard_core::slider::Slider;
use lizard_core::supply::{Rail, Supplies, Thresholds};
use lizard_core::units::{Angle, Scale, Sine, Sweep, Width};

include!(concat!(env!("OUT_DIR"), "/robot.rs"));

lizard_avr::flash! {
    const SERVOS: [Calibration; 4] = CALIBRATION;
    const REACHES: [Reach; 4] = REACH;
    const NEUTRALS: [Angle; 4] = NEUTRAL;
}

/// The robot of robot.toml.
pub struct Lizard;

impl Robot for Lizard {
    #[inline(always)]
    fn end(&self, end: End) -> FiveBar<'static> {
        // A branch that the compiler sees to be none saves flash.
        match end {
            End::Tail if !ENDS_ALIKE => TAIL,
            _ => HEAD,
        }
    }

    #[inline(always)]
    fn side(&self, side: Side) -> Slider {
        match side {
            Side::Right if !SIDES_ALIKE => RIGHT,
            _ => LEFT,
        }
    }

    #[inline(always)]
    fn limits(&self) -> Limits {
        LIMITS
    }

    #[inline(always)]
    fn slew(&self) -> Slew {
        SLEW
    }

    #[inline(always)]
    fn neutral(&self) -> [Angle; 4] {
        NEUTRAL
    }

    #[inline(never)]
    fn neutral_of(&self, servo: Servo) -> Angle {
        NEUTRALS.at(servo.index()).load()
    }

    // Out of line: constants of this size cost less as a table.
    #[inline(never)]
    fn calibration(&self) -> [Calibration; 4] {
        SERVOS.load()
    }

    #[inline(never)]
    fn servo(&self, servo: Servo) -> Calibration {
        SERVOS.at(servo.index()).load()
    }

    #[inline(always)]
    fn gaits(&self) -> Flash<'static, [Gait]> {
        GAITS.as_slice()
    }

    #[inline(always)]
    fn names(&self) -> Flash<'static, [u8]> {
        NAMES.as_slice()
    }

    #[inline(always)]
    fn waves(&self) -> Flash<'static, [Wave]> {
        WAVES.as_slice()
    }

    #[inline(never)]
    fn reach(&self, servo: Servo) -> Reach {
        REACHES.at(servo.index()).load()
    }

    #[inline(always)]
    fn supplies(&self) -> Supplies {
        SUPPLIES
    }

    #[inline(always)]
    fn hash(&self) -> u32 {
        HASH
    }

    #[inline(always)]
    fn servo_hash(&self) -> u32 {
        SERVO_HASH
    }
}
