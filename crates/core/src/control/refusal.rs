//! Refusals: the reasons why the robot does not carry out an order.

use crate::guard::hazard::Hazard;
use crate::numbers::part::Servo;

/// The reason why an order is not carried out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// A servo does not reach the pose, or the pose is not safe.
    Unsafe(Hazard),
    /// The servos get no pulses.
    Resting,
    /// With the new settings, this servo would not reach a sweep that the gaits need.
    TravelTooNarrow(Servo),
    /// With the new settings, the current pose or the target would be outside the travel of this servo.
    PoseOutsideTravel(Servo),
    /// The supply is too low.
    Supply,
    /// The EEPROM has not kept the settings that were written.
    SettingsNotKept,
    /// The EEPROM holds no settings that could be loaded.
    NothingSaved,
    /// The flash holds no usable robot.
    NoRobot,
}
