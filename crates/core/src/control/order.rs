//! The orders that the robot executes.

use crate::memory::settings::Boot;
use crate::numbers::gaits::GaitId;
use crate::numbers::part::Servo;
use crate::numbers::units::{Angle, Sweep};

/// An order whose arguments are within their ranges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Change to a gait for a number of cycles, or endlessly if that is 0; or start a routine for a number of rounds,
    /// or for the number in robot.toml if that is 0. `stand` also wakes the servos.
    Gait(GaitId, u16),
    /// Go to a pose, given as chassis angles in servo order.
    Pose([Angle; 4]),
    /// Go to the neutral pulses without trims.
    Center,
    /// Freeze the pose.
    Stop,
    /// End the pulses.
    Rest,
    /// Set the pace of gaits, in percent of the pace in robot.toml, 10..=100.
    Speed(u8),
    /// Change a setting of a servo.
    Set(Servo, Setting),
    /// Set the action three seconds after power-on.
    Boot(Boot),
    /// End a gait when no command has been received for this number of milliseconds, or never if that is 0.
    Deadman(u16),
    /// Save the settings in the EEPROM.
    Save,
    /// Load the settings from the EEPROM.
    Load,
    /// Restore robot.toml's settings.
    Factory,
}

/// A setting of a servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// The correction of the horn's angle, at most 20 deg in either direction.
    Trim(Sweep),
    /// True if a longer pulse turns the servo counter-clockwise.
    Direction(bool),
    /// The change of the pulse width per degree, in hundredths of a microsecond, 500..=2000.
    Scale(u16),
    /// The limits of the travel as chassis angles, the clockwise limit first.
    Limit(Angle, Angle),
}

/// The progress of an order that was accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acceptance {
    /// The order is done, or its motion has begun.
    Done,
    /// The order waits for the EEPROM; its outcome follows later.
    Pending,
}
