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
    /// With these settings, this servo would not reach a sweep that the gaits need.
    TravelTooNarrow(Servo),
    /// With these settings, this servo would have to leave its present pose or target.
    PoseOutsideTravel(Servo),
    /// The supply is too low.
    Supply,
    /// The EEPROM does not keep the bytes that were written.
    NotKept,
    /// The EEPROM holds no settings that could be loaded.
    NothingSaved,
    /// The flash holds no usable robot.
    NoRobot,
}
