//! Refusals: the reasons for which the robot does not execute an order.

use crate::guard::hazard::Hazard;
use crate::numbers::part::Servo;

/// The reason for which an order is not executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// The pose exceeds a servo's travel or is unsafe.
    Unsafe(Hazard),
    /// The servos get no pulses.
    Resting,
    /// With the new settings, the travel of this servo would not cover the range that the gaits need.
    TravelTooNarrow(Servo),
    /// With the new settings, the travel of this servo would not cover the current pose or the target.
    PoseOutsideTravel(Servo),
    /// The supply is too low.
    SupplyTooLow,
    /// The EEPROM does not hold the settings that were written.
    WriteFailed,
    /// The EEPROM holds no valid settings.
    NothingSaved,
    /// The flash holds no valid robot.
    NoRobot,
}
