//! The orders that the robot takes.

use crate::memory::settings::Boot;
use crate::numbers::gaits::GaitId;
use crate::numbers::part::Servo;
use crate::numbers::units::{Angle, Sweep};

/// An order, its arguments within their ranges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Go over to a gait; `stand` also wakes the servos.
    Gait(GaitId),
    /// Go to a pose, given as chassis angles in servo order.
    Pose([Angle; 4]),
    /// Go to the neutral pulses without trims.
    Center,
    /// Freeze.
    Stop,
    /// End the pulses.
    Rest,
    /// The pace of gaits, 10..=100 percent of their own.
    Speed(u8),
    /// A setting of a servo.
    Set(Servo, Setting),
    /// What is done three seconds after power-on.
    Boot(Boot),
    /// A gait ends when no line has come for this many milliseconds; 0: never.
    Deadman(u16),
    /// Keep the settings.
    Save,
    /// Take the settings that are kept.
    Load,
    /// Take robot.toml's settings.
    Factory,
}

/// A setting of a servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// By how much the horn has to turn, at most 20 deg either way.
    Trim(Sweep),
    /// Whether a longer pulse turns it counter-clockwise.
    Direct(bool),
    /// Hundredths of a microsecond per degree, 500..=2000.
    Scale(u16),
    /// The ends of its travel as chassis angles, clockwise end first.
    Limit(Angle, Angle),
}

/// How an order has been taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taken {
    /// It is done, or under way.
    Done,
    /// The memory will do it, byte by byte; the result comes then.
    Later,
}
